#include "coupling/scan_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "coupling/exposure.hpp"
#include "coupling/ledger.hpp"

namespace layerloop::coupling {
namespace {

Case hatch_case() {
  Case checked;
  checked.machine.accumulation_length = 300e-6;
  checked.machine.gap_length = 100e-6;
  checked.machine.deposition_length = 600e-6;
  checked.machine.width = 250e-6;
  checked.laser.power = 100;
  checked.scan = {ScanKind::hatch, 0.5, 400e-6, 3, 80e-6, std::numbers::pi, 1e-4};
  checked.heat.margin = 50e-6;
  return checked;
}

TEST(ScanPath, TracksGoToAndFroCentredOnTheDepositionZone) {
  std::vector<Track> const tracks = scan_path(hatch_case(), 1);
  ASSERT_EQ(tracks.size(), 3U);
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_NEAR(0.5 * (tracks[t].begin.x() + tracks[t].end.x()), 700e-6, 1e-15);
    EXPECT_NEAR(tracks[t].begin.y(), 125e-6 + (static_cast<double>(t) - 1) * 80e-6, 1e-15);
    EXPECT_NEAR(tracks[t].end_time - tracks[t].begin_time, 400e-6 / 0.5, 1e-15);
    EXPECT_EQ(tracks[t].end.x() > tracks[t].begin.x(), t != 1);
  }
  EXPECT_NEAR(tracks[1].begin_time - tracks[0].end_time, 1e-4, 1e-15);
}

TEST(ScanPath, RotationByHalfATurnSwapsOrderAndDirection) {
  std::vector<Track> const first = scan_path(hatch_case(), 1), second = scan_path(hatch_case(), 2);
  EXPECT_NEAR(second[0].begin.x(), first[0].end.x(), 1e-15);
  EXPECT_NEAR(second[0].begin.y(), first[2].begin.y(), 1e-15);
}

TEST(ScanPath, HeatedRangeHoldsTracksAndMargin) {
  auto const [from, to] = heated_range(hatch_case(), 1);
  EXPECT_NEAR(from, 450e-6, 1e-15);
  EXPECT_NEAR(to, 950e-6, 1e-15);
}

TEST(AbsorbedEnergy, MapHoldsEveryJoule) {
  VoxelGrid const grid{Vec3(0, 0, -1e-5), 5e-6, {4, 3, 2}};
  HeatSource source;
  source.time = {0, 1e-3, 3e-3, 4e-3};
  source.power.resize(3);  // on, off, on
  source.power[0].cell = {0, 5, 13};
  source.power[0].watts = {1, 2, 4};
  source.power[2].cell = {17};
  source.power[2].watts = {8};
  AreaMap const map = absorbed_energy(source, grid);
  double const joules = std::accumulate(map.values.begin(), map.values.end(), 0.0) * grid.cell * grid.cell;
  EXPECT_NEAR(joules, 1e-3 * (1 + 2 + 4 + 8), 1e-15);
  // Cells 5 (lower level) and 17 (upper level) stand in one column.
  EXPECT_NEAR(map.at(1, 1) * grid.cell * grid.cell, 1e-3 * (2 + 8), 1e-15);
}

/// A build whose books balance: 10 fed, 4 in the bed, 3 over the edge, 3 melted.
BuildState balanced_build(double density) {
  BuildState build;
  for (std::int64_t id = 0; id < 4; ++id) build.bed.add(id, Vec3(0, 0, 0), 1e-5, 0);
  double const grain = density * build.bed.volume(0);
  Ledger& ledger = build.record.ledger;
  ledger.particles_fed = 10;
  ledger.particles_overflow = ledger.particles_melted = 3;
  ledger.mass_fed = 10 * grain;
  ledger.mass_overflow = ledger.mass_melted = 3 * grain;
  return build;
}

TEST(Audit, ClosesOverWhatIsThereAndStopsOverWhatIsNot) {
  Case checked;
  checked.material.density = 8190;
  BuildState build = balanced_build(checked.material.density);
  EXPECT_NO_THROW(audit(build, checked));
  EXPECT_EQ(build.record.ledger.particles_bed, 4);
  EXPECT_LT(build.record.ledger.mass_relative_error, 1e-15);

  BuildState grain_missing = balanced_build(checked.material.density);
  grain_missing.record.ledger.particles_fed = 11;
  EXPECT_THROW(audit(grain_missing, checked), PhysicsError);
  BuildState mass_missing = balanced_build(checked.material.density);
  mass_missing.record.ledger.mass_fed *= 1 + 1e-9;
  EXPECT_THROW(audit(mass_missing, checked), PhysicsError);
  BuildState light_missing = balanced_build(checked.material.density);
  light_missing.record.ledger.ray_energy_relative_error = 1e-9;
  EXPECT_THROW(audit(light_missing, checked), PhysicsError);
  BuildState not_a_number = balanced_build(checked.material.density);
  not_a_number.record.ledger.heat_energy_relative_error = std::nan("");
  EXPECT_THROW(audit(not_a_number, checked), PhysicsError);
}

TEST(Audit, StopsOverEnergyOfGrainsThatIsMissing) {
  Case checked;
  checked.material.density = 8190;
  BuildState build = balanced_build(checked.material.density);
  dem::EnergyLedger energy{.wall_work = 1e-9, .residual = 1e-12, .work_done = 2e-9};
  book_motion(build.record.ledger, energy);
  book_motion(build.record.ledger, energy);
  EXPECT_DOUBLE_EQ(build.record.ledger.energy_wall_work, 2e-9);
  EXPECT_DOUBLE_EQ(build.record.ledger.energy_relative_error_dem, 5e-4);
  EXPECT_NO_THROW(audit(build, checked));
  energy.residual = 1e-11;
  book_motion(build.record.ledger, energy);
  EXPECT_THROW(audit(build, checked), PhysicsError);
}

}  // namespace
}  // namespace layerloop::coupling
