// A library for another version of core/user_effect.hpp.
namespace layerloop {
class EffectRegistry;
}
extern "C" int layerloop_plugin_abi() { return 0; }
extern "C" void layerloop_register(layerloop::EffectRegistry&) {}
