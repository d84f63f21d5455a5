// What explain writes: the contract's keys, tables that match the pictures, and a page that needs no network.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "sample_explanation.hpp"
#include "validation/explain_output.hpp"
#include "validation/explain_page.hpp"
#include "validation/explain_tables.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

bool holds(std::string const& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Explain, summary_holds_what_scripts_rely_on) {
  Explanation const explained = sample_explanation();
  nlohmann::json const all = explain_summary(explained);
  EXPECT_EQ(all.at("verdict"), "GROUP");
  ASSERT_EQ(all.at("effects").size(), 1U);  // those of the verdict alone
  nlohmann::json const& effect = all.at("effects")[0];
  EXPECT_EQ(effect.at("name"), "keyhole");
  EXPECT_EQ(effect.at("group").size(), 1U);
  for (std::string const key : {"strength", "u_strength", "z", "evidence", "kept_fraction"})
    EXPECT_TRUE(effect.at(key).is_number()) << key;
  EXPECT_EQ(all.at("candidates").size(), 5U);
  EXPECT_TRUE(all.at("candidates")[2].at("chi2_after").is_null());  // never refitted: no number
  EXPECT_NEAR(all.at("chi2_after").get<double>(), explained.found.table.residual_after.squaredNorm(), 1e-12);
  EXPECT_EQ(all.at("pattern"), "");  // nothing significant is left
  EXPECT_EQ(all.at("model_runs"), 41.5);
  nlohmann::json const& next = all.at("next")[0];
  EXPECT_EQ(next.at("quantity"), "absorptivity");
  EXPECT_EQ(next.at("conditions").at("laser.power"), 250);
  EXPECT_EQ(next.at("replicates"), 3);
  EXPECT_EQ(next.at("separates").size(), 2U);
}

TEST(Explain, answer_begins_with_the_verdict_and_ends_with_what_to_measure) {
  std::string const text = answer_in_words(sample_explanation());
  EXPECT_TRUE(text.starts_with("VERDICT: GROUP\n"));
  EXPECT_LT(std::ranges::count(text, '\n'), 25);  // one screen
  EXPECT_LT(text.find("VERDICT"), text.find("0.31 +- 0.03"));
  EXPECT_LT(text.find("0.31 +- 0.03"), text.find("MEASURE: absorptivity at laser.power = 250 W"));
}

TEST(Explain, written_and_read_again_is_the_same) {
  fs::path const folder = fs::temp_directory_path() / "explain_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  Explanation const explained = sample_explanation();
  write_explanation(folder, explained);
  ReadExplanation const read = read_explanation(folder);
  EXPECT_EQ(read.verdict, "GROUP");
  ASSERT_EQ(read.addition.effects.size(), 1U);
  EXPECT_EQ(read.addition.effects[0].strength, 0.31);
  EXPECT_EQ(read.groups[0], std::vector<std::string>{"plume_attenuation"});
  EXPECT_EQ(read.addition.calibration_with.at("laser.absorptivity"), 0.38);
  EXPECT_EQ(read.addition.calibration_without.at("laser.absorptivity"), 0.41);
  std::string const observations = read_file(folder / "observations.csv");
  EXPECT_EQ(std::ranges::count(observations, '\n'), 61);
  EXPECT_TRUE(holds(observations, "o0,c0,pool.depth,um,"));
  for (std::string const name :
       {"signatures", "cosines", "candidates", "parameters", "patterns", "next", "stages", "waterfall"})
    EXPECT_TRUE(fs::exists(folder / (name + ".csv"))) << name;
  write_file(folder / "summary.json", "{\"verb\": \"melt\"}");
  EXPECT_THROW(read_explanation(folder / "summary.json"), InputError);
  fs::remove_all(folder);
}

TEST(Explain, page_has_all_sections_and_needs_no_network) {
  std::string const html = explain_page(sample_explanation());
  for (std::string const id : {"limits", "parity", "residuals", "stages", "evidence", "signatures", "confusion",
                               "pulls", "waterfall", "next", "outliers", "provenance"})
    EXPECT_TRUE(holds(html, "<section id=\"" + id + "\">")) << id;
  EXPECT_TRUE(holds(html, "tracks &lt;on a plate&gt;"));
  EXPECT_TRUE(holds(html, "no quantity of this study sees a bed"));
  EXPECT_FALSE(holds(html, "http://") || holds(html, "https://") || holds(html, "style=\""));
  EXPECT_EQ(html, explain_page(sample_explanation()));
}

TEST(Waterfall, ends_at_the_noise_and_shares_count_from_calibration) {
  Diagnosis found;
  found.chi2_base = 400, found.chi2_before = 150, found.chi2_after = 60, found.dof = 50;
  found.effects = {{.name = "keyhole", .active = true}};
  std::vector<WaterfallStep> const steps = waterfall(found);
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[2].name, "with keyhole");
  EXPECT_EQ(steps[3].chi2, 50);
  EXPECT_DOUBLE_EQ(share_explained(found, 60), 0.9);
  EXPECT_DOUBLE_EQ(share_explained(found, 30), 1);  // below the noise is no more than all
  EXPECT_TRUE(std::isnan(share_explained(found, std::nan(""))));
}

TEST(StageMisfit, is_the_mean_square_by_the_stage_of_the_quantity) {
  Explanation e = sample_explanation();
  e.found.table.residual_before.setConstant(2);
  e.found.table.residual_after.setConstant(1);
  double readings = 0;
  for (StageMisfit const& misfit : stage_misfits(e)) {
    EXPECT_DOUBLE_EQ(misfit.before, 4);
    EXPECT_DOUBLE_EQ(misfit.after, 1);
    readings += static_cast<double>(misfit.observations);
  }
  EXPECT_EQ(readings, 60);
}

}  // namespace
}  // namespace layerloop::validation
