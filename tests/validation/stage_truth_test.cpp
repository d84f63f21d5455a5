// The truth of the blind studies that the stages themselves tell.
#include "validation/truth/stage_truth.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/write_file.hpp"
#include "tests/plate_track.hpp"
#include "validation/blind/stage_design.hpp"
#include "validation/blind/world.hpp"
#include "validation/stage_model.hpp"
#include "validation/study_setup.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;

std::string const plate = plate_track + "[effects.latent_heat]\nenabled = false\n";

/// Four tracks on a plate, alike two by two, and what was computed, in a folder that goes away.
struct Tracks {
  fs::path folder = fs::temp_directory_path() / ("layerloop_stage_truth_" + std::to_string(::getpid()));
  Study study;
  std::vector<Candidate> candidates;
  Eigen::VectorXd calibration{{0.32}};

  Tracks() {
    fs::remove_all(folder);
    fs::create_directories(folder);
    write_file(folder / "case.toml", plate);
    write_file(folder / "study.toml",
               "[study]\ncase = \"case.toml\"\n[[calibration]]\nkey = \"laser.absorptivity\"\nmean = 0.3\nsd = 0.03\n");
    write_file(folder / "conditions.csv",
               "condition_id,laser.power [W],scan.scan_speed [m/s],machine,lot\n"
               "a,45,0.5,A,L1\nb,60,0.5,A,L1\nc,45,0.5,B,L2\nd,60,0.5,B,L2\n");
    std::string rows = "obs_id,condition_id,quantity,value,unit,u_stat\n";
    for (std::string const id : {"a", "b", "c", "d"})
      rows += "w" + id + "," + id + ",pool.width,90,um,2\nd" + id + "," + id + ",pool.depth,30,um,2\n";
    write_file(folder / "measurements.csv", rows);
    study = read_study(folder);
    candidates = candidates_for(study, first_case(study));
  }
  ~Tracks() { fs::remove_all(folder); }

  Eigen::VectorXd truth(std::vector<HiddenCause> const& causes, std::map<std::string, double> resolution = {}) const {
    return stage_truth({folder / "cache", std::move(resolution), 1}, study, candidates, calibration, causes, 3);
  }
  Eigen::VectorXd model(std::string const& candidate = "", double strength = 0) const {
    Communicator const comm;
    Eigen::VectorXd strengths = Eigen::VectorXd::Zero(index(candidates.size()));
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (candidates[c].name == candidate) strengths[index(c)] = strength;
    return stage_model(study, candidates, {.cache = folder / "cache", .quiet = true}, comm)
        ->predict({calibration, strengths, 0})
        .value;
  }
};

TEST(StageTruth, is_the_model_when_nothing_is_hidden_on_the_same_mesh) {
  Tracks const tracks;
  EXPECT_EQ(tracks.truth({}), tracks.model());
  EXPECT_NE(tracks.truth({}, {{"heat.cell_size", 6e-6}}), tracks.model());
}

TEST(StageTruth, has_effects_in_the_catalogues_form_and_in_another) {
  Tracks const tracks;
  Eigen::VectorXd const plain = tracks.model(), same = tracks.truth({{"latent_heat", 0.8}});
  EXPECT_EQ(same, tracks.model("latent_heat", 0.8));
  Eigen::VectorXd const a = same - plain,
                        b = tracks.truth({{.name = "latent_heat", .strength = 0.8, .other_form = true}}) - plain;
  EXPECT_GT((a - b).norm(), 0.02 * a.norm());
  EXPECT_GT(a.dot(b) / (a.norm() * b.norm()), 0.8);
}

TEST(StageTruth, acts_on_the_conditions_that_a_cause_is_of) {
  Tracks const tracks;
  Eigen::VectorXd const plain = tracks.truth({}), dirty = tracks.truth({{"dirty_window", 1}}),
                        late = tracks.truth({{"focus_jump", 1, 0.5}}),
                        biased = tracks.truth({{"error of laser.power", -0.1, 0, "B"}});
  EXPECT_TRUE(plain.allFinite());
  EXPECT_EQ(dirty.head(4), plain.head(4));
  EXPECT_TRUE((dirty.tail(4).array() < plain.tail(4).array()).all());
  EXPECT_EQ(dirty, biased);
  EXPECT_EQ(late, plain) << "the case gives the spot, no condition does";
}

TEST(StageWorld, draws_studies_whose_conditions_share_their_beds) {
  fs::path const folder = fs::temp_directory_path() / ("layerloop_stage_world_" + std::to_string(::getpid()));
  for (StageDesign const& design : stage_designs()) {
    auto const world = stage_world(design.name, folder / design.name);
    Study const study = world->design(5), other = world->design(6);
    EXPECT_EQ(study.conditions.size(), design.conditions.size());
    bool same_order = true;
    for (std::size_t c = 0; c < study.conditions.size(); ++c)
      same_order &= study.conditions[c].inputs == other.conditions[c].inputs;
    EXPECT_FALSE(same_order) << design.name;
    std::vector<Candidate> const candidates = world->candidates(study);
    for (std::string const& name : world->hidden_effects()) {
      auto const found = std::ranges::find(candidates, name, &Candidate::name);
      ASSERT_NE(found, candidates.end()) << name;
      EXPECT_EQ(found->kind, EffectClass::physics) << name;
    }
    EXPECT_NO_THROW(world->model(study, candidates)) << design.name;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace layerloop::validation
