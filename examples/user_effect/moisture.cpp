// An effect of one's own in one file: adsorbed water that joins grains where they touch.
#include <numbers>

#include "core/user_effect.hpp"

namespace {

/// A thin water film holds two touching spheres with 4 pi gamma R cos(theta), R their reduced radius, however little of
/// it there is (Israelachvili, Intermolecular and Surface Forces, 3rd ed., 17.10).
class Moisture : public layerloop::PairAttraction {
 public:
  void add(layerloop::TouchingPairs const& pairs, layerloop::EffectValues const& values,
           double* attraction) const override {
    double const per_radius = values.strength * 4 * std::numbers::pi * values("surface_tension");
    for (std::size_t p = 0; p < pairs.count; ++p) attraction[p] += per_radius * pairs.reduced_radius[p];
  }
};

}  // namespace

LAYERLOOP_PLUGIN

extern "C" void layerloop_register(layerloop::EffectRegistry& registry) {
  using namespace layerloop;
  Effect row{"moisture", EffectStage::dem};
  row.largest_strength = 1;
  row.prior_scale = 0.01;  // share of the contacts' rim that is wet
  row.sentence = "Adsorbed water that joins grains where they touch; the strength is the share of the rim that is wet.";
  row.source = "Israelachvili, Intermolecular and Surface Forces, 17.10";
  row.parameters = {{"surface_tension",
                     Dimension::surface_energy,
                     {0.01, 0.1},
                     "\"0.072 N/m\"",
                     0.01,
                     "Surface tension of the water."}};
  registry.add(row, std::make_shared<Moisture>());
}
