// The permanent blind test: sealed scenarios are drawn, diagnosed, opened and scored, and the harness itself is tested.
#include "validation/blind/blind_test.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/blind/blind_page.hpp"
#include "validation/blind/seal.hpp"
#include "validation/digest.hpp"
#include "validation/study_file.hpp"
#include "validation/truth/readings.hpp"
#include "validation/truth/true_chain.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

/// A folder that goes away.
struct Folder {
  fs::path path;
  explicit Folder(std::string const& name)
      : path(fs::temp_directory_path() / ("layerloop_blind_" + name + std::to_string(::getpid()))) {
    fs::remove_all(path);
  }
  ~Folder() { fs::remove_all(path); }
};

TEST(Wilson, is_the_interval_of_the_published_formula) {
  // 95 % interval of 81 of 263: Newcombe, Stat. Med. 17 (1998) 857, table I, method 3.
  Interval const interval = wilson(81, 263);
  EXPECT_NEAR(interval.low, 0.2553, 5e-5);
  EXPECT_NEAR(interval.high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 5e-5);
  EXPECT_EQ(wilson(0, 20).low, 0);
}

TEST(Seal, opens_with_its_seed_only_and_not_when_changed) {
  std::string const text = "the keyhole", box = seal(text, 7, "scored", "s001");
  EXPECT_EQ(unseal(box, 7, "scored", "s001"), text);
  EXPECT_EQ(box.find("keyhole"), std::string::npos);
  EXPECT_THROW(unseal(box, 8, "scored", "s001"), InputError);
  EXPECT_THROW(unseal(box, 7, "development", "s001"), InputError);
  EXPECT_THROW(unseal(box, 7, "scored", "s002"), InputError);
  std::string changed = box;
  changed.back() ^= 1;
  EXPECT_THROW(unseal(changed, 7, "scored", "s001"), InputError);
}

TEST(Seal, hashes_as_published) {  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Seal, draws_development_and_scored_sets_from_different_seeds) {
  EXPECT_NE(secret_of(1, "scored", "s001"), secret_of(1, "development", "s001"));
}

TEST(Truth, is_the_chain_when_nothing_is_hidden) {
  auto const world = analytic_world();
  Study const study = world->design(3);
  auto const model = world->model(study, {});
  Eigen::VectorXd calibration(static_cast<Eigen::Index>(study.calibration.size()));
  for (std::size_t k = 0; k < study.calibration.size(); ++k)
    calibration[static_cast<Eigen::Index>(k)] = study.calibration[k].mean + 0.7 * study.calibration[k].sd;
  Eigen::VectorXd const truth = world->truth(study, calibration, {}, 0),
                        chain = model->predict({calibration, Eigen::VectorXd(0)}).value;
  EXPECT_LT(((truth - chain).array() / chain.array()).abs().maxCoeff(), 0.012);  // the kink in a table of widths
  EXPECT_LT(((truth - chain).array() / chain.array()).abs().mean(), 5e-4);
}

TEST(Truth, has_other_forms_than_the_chain) {
  auto const world = analytic_world();
  Study const study = world->design(3);
  std::vector<Candidate> const candidates = world->candidates(study);
  auto const model = world->model(study, candidates);
  ModelPoint point{Eigen::VectorXd(static_cast<Eigen::Index>(study.calibration.size())),
                   Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidates.size()))};
  for (std::size_t k = 0; k < study.calibration.size(); ++k)
    point.calibration[static_cast<Eigen::Index>(k)] = study.calibration[k].mean;
  Eigen::VectorXd const base = model->predict(point).value, plain = world->truth(study, point.calibration, {}, 0);
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (candidates[c].kind != EffectClass::physics || candidates[c].name == "latent_heat") continue;
    ModelPoint with = point;
    with.strengths[static_cast<Eigen::Index>(c)] = candidates[c].prior_scale;
    Eigen::VectorXd const chain = model->predict(with).value - base;
    Eigen::VectorXd const truth =
        world->truth(study, point.calibration, {{candidates[c].name, candidates[c].prior_scale}}, 0) - plain;
    EXPECT_GT(truth.cwiseQuotient(base).norm(), 0.01) << candidates[c].name << " does nothing";
    EXPECT_GT((chain - truth).cwiseQuotient(base).norm(), 1e-3) << candidates[c].name << " has the catalogue's form";
    EXPECT_LT((chain - truth).cwiseQuotient(base).norm(), 0.8 * truth.cwiseQuotient(base).norm()) << candidates[c].name;
  }
}

TEST(Readings, scatter_as_their_study_says) {
  Study study = analytic_design(1);
  Eigen::VectorXd const truth = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(study.observables.size()), 1e-4);
  double sum = 0;
  std::size_t n = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    for (Observation& row : study.observations) row.u_sys_rel = 0;
    take_readings(study, truth, {.heavy_tails = seed % 2 == 1, .noise_factor = 2}, seed);
    for (Observation const& row : study.observations) sum += std::pow((row.value - 1e-4) / row.u_stat, 2), ++n;
  }
  EXPECT_NEAR(sum / static_cast<double>(n), 4, 0.25);
}

TEST(BlindTest, writes_studies_that_read_back_bit_for_bit) {
  Folder const folder("files");
  make_blind_test(folder.path, "analytic", 3, 4, BlindSet::development);
  auto const world = analytic_world();
  Scenario const drawn = draw_scenario(*world, world->classes()[1], "s002", secret_of(4, "development", "s002"));
  Study const read = read_study(folder.path / "s002"), expected = part_of(drawn.study, Role::train);
  ASSERT_EQ(read.observations.size(), expected.observations.size());
  for (std::size_t i = 0; i < read.observations.size(); ++i) {
    EXPECT_EQ(read.observations[i].value, expected.observations[i].value);
    EXPECT_EQ(read.observations[i].u_stat, expected.observations[i].u_stat);
    EXPECT_EQ(read.observables[read.observations[i].observable],
              expected.observables[expected.observations[i].observable]);
  }
  ASSERT_EQ(read.calibration.size(), expected.calibration.size());
  for (std::size_t k = 0; k < read.calibration.size(); ++k) {
    EXPECT_EQ(read.calibration[k].key, expected.calibration[k].key);
    EXPECT_NEAR(read.calibration[k].sd, expected.calibration[k].sd, 1e-12);
  }
}

TEST(BlindTest, refuses_what_was_changed_and_what_is_out_of_order) {
  Folder const folder("order");
  make_blind_test(folder.path, "analytic", 2, 4, BlindSet::development);
  EXPECT_THROW(make_blind_test(folder.path, "analytic", 2, 4, BlindSet::development), InputError);
  EXPECT_THROW(open_blind_test(folder.path, 4), InputError);
  EXPECT_THROW(opened_blind_test(folder.path), InputError);
  run_blind_test(folder.path, Also::nothing);
  EXPECT_THROW(run_blind_test(folder.path, Also::nothing), InputError);
  EXPECT_THROW(open_blind_test(folder.path, 5), InputError);
  std::string const verdict = read_file(folder.path / "s001/verdict.json");
  write_file(folder.path / "s001/verdict.json", verdict + " ");
  EXPECT_THROW(open_blind_test(folder.path, 4), InputError);
  write_file(folder.path / "s001/verdict.json", verdict);
  EXPECT_EQ(open_blind_test(folder.path, 4).size(), 2U);
  std::string const box = read_file(folder.path / "s002/answer.sealed");
  write_file(folder.path / "s002/answer.sealed", box + "x");
  EXPECT_THROW(open_blind_test(folder.path, 4), InputError);
}

/// Chance of a count as bad as this if the bar were just met: what tells a fault from the luck of a small set.
double chance(Score const& score) {
  boost::math::binomial const at_bar(static_cast<double>(score.n), score.minimum);
  auto const hits = static_cast<double>(score.hits);
  if (score.high_is_good) return boost::math::cdf(at_bar, hits);
  return score.hits == 0 ? 1 : boost::math::cdf(boost::math::complement(at_bar, hits - 1));
}

/// Every bar holds: shares within what a set of this size can tell, figures by their value. The table is printed.
TEST(BlindTest, of_more_than_two_hundred_sealed_scenarios_is_passed) {
  Folder const folder("permanent");
  make_blind_test(folder.path, "analytic", 220, 20, BlindSet::development);
  run_blind_test(folder.path, Also::baselines);
  std::vector<Opened> const opened = open_blind_test(folder.path, 20);
  std::vector<Score> const scores = scores_of(opened);
  std::printf("%s", text_of(scores).c_str());
  EXPECT_GE(opened.size(), 200U);
  for (Score const& score : scores) {
    EXPECT_GT(score.n, 0U) << score.name << ": " << score.of;
    EXPECT_TRUE(score.passes() || (score.is_share && chance(score) > 0.005))
        << score.name << ": " << score.of << ": " << score.value;
  }
  for (std::size_t method = 0; method < static_cast<std::size_t>(baselines); ++method) {
    std::vector<Score> const others = scores_of(opened, method);
    std::size_t mine = 0, theirs = 0;
    for (std::size_t i = 0; i < others.size(); ++i) {
      if (scores[i].name != "false claim of physics") continue;
      mine += scores[i].hits, theirs += others[i].hits;
    }
    EXPECT_LT(mine, theirs) << name_of(static_cast<Baseline>(method)) << ": false claims";
  }
}

}  // namespace
}  // namespace layerloop::validation
