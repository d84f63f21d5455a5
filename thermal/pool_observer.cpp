#include "thermal/pool_observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace layerloop::thermal {
namespace {
void max_over_ranks(std::vector<float>& values, Communicator const& comm) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_FLOAT, MPI_MAX, comm.handle());
}
}  // namespace

std::vector<float> gather(HeatCells const& cells, LocalBox const& box, std::span<float const> own,
                          Communicator const& comm) {
  std::vector<float> field(static_cast<std::size_t>(cells.grid.size()), 0);
  for (std::int32_t k = 0; k < box.n[2]; ++k) {
    for (std::int32_t j = 0; j < box.n[1]; ++j) {
      std::copy_n(&own[static_cast<std::size_t>(box.index(0, j, k))], box.n[0],
                  &field[static_cast<std::size_t>(cells.grid.index(box.begin[0], box.begin[1] + j, box.begin[2] + k))]);
    }
  }
  max_over_ranks(field, comm);
  return field;
}

std::vector<float> to_temperature(HeatCells const& cells, EnthalpyTable const& table,
                                  std::vector<float> const& enthalpy) {
  std::vector<float> T(enthalpy.size());
  for (std::size_t c = 0; c < T.size(); ++c) {
    double const h = cells.metal[c] ? enthalpy[static_cast<std::size_t>(cells.host[c])] : 0.0;
    T[c] = static_cast<float>(table.temperature(h));
  }
  return T;
}

PoolObserver::PoolObserver(HeatCells const& cells, std::span<double const> solid, std::vector<Track> const& tracks,
                           double isotherm, Communicator const& comm)
    : cells_(cells), solid_(solid), tracks_(tracks), isotherm_(isotherm), comm_(comm) {
  for (Track const& track : tracks) {
    double const length = std::abs(track.end.x() - track.begin.x());
    if (std::abs(track.end.y() - track.begin.y()) > 1e-9 * length) {
      throw InputError(
          "a track does not run along x (pool sizes are taken in planes across x) set scan.rotation to 0 or 180 deg");
    }
  }
}

void PoolObserver::observe(HeatSystem& system, double time) {
  while (next_ < tracks_.size() && time > tracks_[next_].begin_time) {
    end_track(system);
    begin_track(system, next_);
  }
  if (next_ == 0) return;
  Track const& track = tracks_[next_ - 1];
  double const passed = (time - track.begin_time) / (track.end_time - track.begin_time);
  double const travel = passed * (track.end - track.begin).norm();
  bool const in_the_middle = passed > 0.45 && passed < 0.55;
  if (!in_the_middle || travel < last_sample_ + 2 * cells_.grid.cell) return;
  last_sample_ = travel;
  lengths_.push_back(length_now(system, track));
}

void PoolObserver::begin_track(HeatSystem& system, std::size_t track) {
  earlier_peak_ = system.peak;
  for (std::size_t c = 0; c < system.peak.size(); ++c) system.peak[c] = static_cast<float>(system.enthalpy[c]);
  lengths_.clear();
  last_sample_ = 0;
  next_ = track + 1;
}

void PoolObserver::end_track(HeatSystem& system) {
  if (next_ == 0) return;
  Track const& track = tracks_[next_ - 1];
  VoxelGrid const& grid = cells_.grid;
  std::vector<float> const T =
      to_temperature(cells_, system.table, gather(cells_, system.conduction.box, system.peak, comm_));
  std::vector<PoolSize> sections;
  for (double const place : section_places) {
    Vec3 const at = track.begin + place * (track.end - track.begin);
    auto const i = grid.locate(at)[0];
    if (i < 0 || i >= grid.n[0]) continue;
    auto const size = measure_section(cells_, T, solid_, static_cast<std::int32_t>(i), at.y(), isotherm_);
    if (size) sections.push_back(*size);
  }
  pools_.push_back(summarise(sections, lengths_));
  for (std::size_t c = 0; c < system.peak.size(); ++c) system.peak[c] = std::max(system.peak[c], earlier_peak_[c]);
}

void PoolObserver::finish(HeatSystem& system) {
  end_track(system);
  pools_.resize(tracks_.size());
}

/// The profile along x is the hottest metal within four cells of the track's line, at any height.
double PoolObserver::length_now(HeatSystem const& system, Track const& track) const {
  LocalBox const& box = system.conduction.box;
  VoxelGrid const& grid = cells_.grid;
  double const period = grid.cell * grid.n[1];
  std::vector<float> profile(static_cast<std::size_t>(grid.n[0]), 0);
  for (std::int32_t j = 0; j < box.n[1]; ++j) {
    double aside = std::abs(grid.centre(0, box.begin[1] + j, 0).y() - track.begin.y());
    if (cells_.side_y == SideY::periodic) aside = std::abs(std::remainder(aside, period));
    if (aside > 4 * grid.cell) continue;
    for (std::int32_t k = 0; k < box.n[2]; ++k) {
      for (std::int32_t i = 0; i < box.n[0]; ++i) {
        auto& hottest = profile[static_cast<std::size_t>(box.begin[0] + i)];
        hottest = std::max(hottest, static_cast<float>(system.enthalpy[box.index(i, j, k)]));
      }
    }
  }
  max_over_ranks(profile, comm_);
  for (float& value : profile) value = static_cast<float>(system.table.temperature(value));
  return measure_length(profile, grid.cell, isotherm_);
}

void PoolObserver::write(MeltRecord& record) const {
  PoolSize variance;
  double melting = 0;
  record.pool = {};
  for (TrackPool const& track : pools_) {
    record.track_pools.push_back(track.mean);
    if (track.mean.width == 0) continue;
    ++melting;
    for (auto member : {&PoolSize::width, &PoolSize::depth, &PoolSize::length}) {
      record.pool.*member += track.mean.*member;
      variance.*member += track.variance.*member;
    }
  }
  record.pool_u_num = {};
  if (melting == 0) return;
  for (auto member : {&PoolSize::width, &PoolSize::depth, &PoolSize::length}) {
    record.pool.*member /= melting;
    record.pool_u_num.*member = std::hypot(0.5 * cells_.grid.cell, std::sqrt(variance.*member / melting));
  }
}

}  // namespace layerloop::thermal
