// Keys put into the text of a case, which stays its author's otherwise.
#include "validation/case_text.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace layerloop::validation {
namespace {

std::string const text =
    "# my tracks\n"
    "[laser]\n"
    "  power = \"200 W\"  # measured\n"
    "\n"
    "# the plate\n"
    "[heat]\n"
    "cell_size = 5e-6\n";

TEST(CaseText, keys_change_in_their_line_and_new_ones_join_their_table) {
  EXPECT_EQ(with_settings(text,
                          {"laser.power=180 W", "laser.absorptivity=0.4", "effects.keyhole.enabled=true",
                           "effects.keyhole.strength=0.31"},
                          "+- 0.03"),
            "# my tracks\n"
            "[laser]\n"
            "  power = \"180 W\"  # was \"200 W\"; +- 0.03\n"
            "absorptivity = 0.4  # +- 0.03\n"
            "\n"
            "# the plate\n"
            "[heat]\n"
            "cell_size = 5e-6\n"
            "\n"
            "[effects.keyhole]\n"
            "enabled = true  # +- 0.03\n"
            "strength = 0.31  # +- 0.03\n");
}

TEST(CaseText, nothing_to_set_leaves_every_byte) { EXPECT_EQ(with_settings(text, {}, "x"), text); }

TEST(CaseText, lines_that_hold_more_than_a_key_are_refused) {
  EXPECT_THROW(
      with_settings("[effects]\nkeyhole = {enabled = false, strength = 1}\n", {"effects.keyhole.strength=0.3"}, ""),
      InputError);
  EXPECT_THROW(with_settings("[heat]\nsize = [1e-3,\n 2e-3, 3e-3]\n", {"heat.size=[1e-3, 1e-3, 1e-3]"}, ""),
               InputError);
}

}  // namespace
}  // namespace layerloop::validation
