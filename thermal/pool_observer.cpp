#include "thermal/pool_observer.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace layerloop::thermal {
namespace {
template <class Real>
void max_over_ranks(std::vector<Real>& values, Communicator const& comm) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()),
                std::is_same_v<Real, float> ? MPI_FLOAT : MPI_DOUBLE, MPI_MAX, comm.handle());
}

}  // namespace

template <class Real>
std::vector<Real> gather(HeatCells const& cells, LocalBox const& box, std::span<Real const> own,
                         Communicator const& comm) {
  std::vector<Real> field(static_cast<std::size_t>(cells.grid.size()), 0);
  for (std::int32_t k = 0; k < box.n[2]; ++k) {
    for (std::int32_t j = 0; j < box.n[1]; ++j) {
      std::copy_n(&own[static_cast<std::size_t>(box.index(0, j, k))], box.n[0],
                  &field[static_cast<std::size_t>(cells.grid.index(box.begin[0], box.begin[1] + j, box.begin[2] + k))]);
    }
  }
  max_over_ranks(field, comm);
  return field;
}

template std::vector<float> gather(HeatCells const&, LocalBox const&, std::span<float const>, Communicator const&);
template std::vector<double> gather(HeatCells const&, LocalBox const&, std::span<double const>, Communicator const&);

std::vector<float> to_temperature(HeatCells const& cells, EnthalpyTable const& table,
                                  std::vector<float> const& enthalpy) {
  std::vector<float> T(enthalpy.size());
  for (std::size_t c = 0; c < T.size(); ++c) {
    double const h = cells.metal[c] ? enthalpy[static_cast<std::size_t>(cells.host[c])] : 0.0;
    T[c] = static_cast<float>(table.temperature(h));
  }
  return T;
}

PoolObserver::PoolObserver(HeatCells const& cells, CellContent const& content, std::vector<Track> const& tracks,
                           PoolIsotherms isotherms, Communicator const& comm)
    : cells_(cells), content_(content), tracks_(tracks), isotherms_(isotherms), comm_(comm) {
  if (tracks.empty()) return;
  Track const& track = tracks[tracks.size() / 2];
  Vec3 const middle = 0.5 * (track.begin + track.end);
  VoxelGrid const& grid = cells.grid;
  auto cell = grid.locate(middle);
  probe_.x = middle.x(), probe_.y = middle.y();
  for (cell[2] = grid.n[2] - 1; cell[2] >= 0 && probed_ < 0; --cell[2]) {
    if (!grid.contains(cell)) continue;
    std::int64_t const c = grid.index(cell[0], cell[1], cell[2]);
    if (cells.host[static_cast<std::size_t>(c)] == c) probed_ = c;
  }
}

void PoolObserver::observe(HeatSystem& system, double time) {
  while (next_ < tracks_.size() && time > tracks_[next_].begin_time) {
    end_track(system);
    begin_track(system, next_);
  }
  if (next_ == 0) return;
  if (next_ > tracks_.size() / 2) probe(system, time);
  Track const& track = tracks_[next_ - 1];
  double const passed = (time - track.begin_time) / (track.end_time - track.begin_time);
  double const travel = passed * (track.end - track.begin).norm();
  bool const in_the_middle = passed > 0.45 && passed < 0.55;
  if (!in_the_middle || travel < last_sample_ + 2 * cells_.grid.cell) return;
  last_sample_ = travel;
  lengths_.push_back(length_now(system, track));
}

void PoolObserver::begin_track(HeatSystem& system, std::size_t track) {
  earlier_peak_.assign(system.peak.begin(), system.peak.end());
  for (std::size_t c = 0; c < system.peak.size(); ++c) system.peak[c] = static_cast<float>(system.enthalpy[c]);
  lengths_.clear();
  last_sample_ = 0;
  next_ = track + 1;
}

void PoolObserver::probe(HeatSystem const& system, double time) {
  std::int64_t const own = probed_ < 0 ? -1 : system.conduction.box.own(cells_.grid.coordinates(probed_));
  if (own < 0) return;
  probe_.time.push_back(time);
  probe_.temperature.push_back(system.table.temperature(system.enthalpy[static_cast<std::size_t>(own)]));
}

void PoolObserver::end_track(HeatSystem& system) {
  if (next_ == 0) return;
  Track const& track = tracks_[next_ - 1];
  std::vector<float> const T =
      to_temperature(cells_, system.table, gather<float>(cells_, system.conduction.box, system.peak, comm_));
  Vec3 const along = (track.end - track.begin).normalized();
  std::vector<TrackSection> sections;
  for (double const place : section_places) {
    Vec3 const at = track.begin + place * (track.end - track.begin);
    auto section = measure_section(cells_, T, content_, at, along, isotherms_.pool);
    if (!section) continue;
    section->track = static_cast<std::int32_t>(next_ - 1);
    section->along = place * (track.end - track.begin).norm();
    section->x = at.x(), section->y = at.y();
    if (auto const boiling = measure_section(cells_, T, content_, at, along, isotherms_.boiling))
      section->boiling_depth = boiling->depth;
    sections.push_back(*section);
  }
  pools_.push_back(summarise(sections, lengths_));
  sections_.insert(sections_.end(), sections.begin(), sections.end());
  for (std::size_t c = 0; c < system.peak.size(); ++c) system.peak[c] = std::max(system.peak[c], earlier_peak_[c]);
}

void PoolObserver::finish(HeatSystem& system) {
  end_track(system);
  pools_.resize(tracks_.size());
}

/// The profile along the track is the hottest metal within four cells of its line, at any height.
double PoolObserver::length_now(HeatSystem const& system, Track const& track) const {
  LocalBox const& box = system.conduction.box;
  VoxelGrid const& grid = cells_.grid;
  std::vector<float> hottest(static_cast<std::size_t>(grid.n[0]) * static_cast<std::size_t>(grid.n[1]), 0);
  for (std::int32_t j = 0; j < box.n[1]; ++j) {
    for (std::int32_t k = 0; k < box.n[2]; ++k) {
      for (std::int32_t i = 0; i < box.n[0]; ++i) {
        auto& column = hottest[static_cast<std::size_t>(grid.index(box.begin[0] + i, box.begin[1] + j, 0))];
        column = std::max(column, static_cast<float>(system.enthalpy[box.index(i, j, k)]));
      }
    }
  }
  max_over_ranks(hottest, comm_);
  SampleLine const line(cells_, 0.5 * (track.begin + track.end), (track.end - track.begin).normalized());
  std::vector<float> profile;
  for (std::int64_t step = line.first; step <= line.last; ++step) {
    double warmest = 0;
    for (std::int64_t aside = -4; aside <= 4; ++aside) {
      double T = 0;
      for (auto const& [i, j, share] : line.corners(step, aside))
        T += share * system.table.temperature(hottest[static_cast<std::size_t>(grid.index(i, j, 0))]);
      warmest = std::max(warmest, T);
    }
    profile.push_back(static_cast<float>(warmest));
  }
  return measure_length(profile, grid.cell, isotherms_.pool);
}

void PoolObserver::write(MeltRecord& record) const {
  record.sections = sections_;
  record.probe = probe_;  // one rank knows it
  record.probe.time = comm_.all_gather(probe_.time);
  record.probe.temperature = comm_.all_gather(probe_.temperature);
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
