#include "apps/verbs.hpp"

namespace layerloop::apps {

void add_spread(CLI::App& program, Action& chosen) {
  add_layer_verb(program, chosen, "spread",
                 "layers of powder without a laser: density, thickness, sizes, heap and reservoir", Process::spreading);
}

}  // namespace layerloop::apps
