#include "dem/decomposition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "dem/multisection.hpp"

namespace layerloop::dem {
namespace {
/// Sends to_rank[r] to rank r.
/// \return what came in, by rank
template <class T>
std::vector<std::vector<T>> exchange(Communicator const& communicator, std::vector<std::vector<T>> const& to_rank) {
  auto const ranks = static_cast<std::size_t>(communicator.size());
  std::vector<int> sent(ranks), received(ranks), sent_at(ranks), received_at(ranks);
  for (std::size_t r = 0; r < ranks; ++r) sent[r] = static_cast<int>(to_rank[r].size() * sizeof(T));
  MPI_Alltoall(sent.data(), 1, MPI_INT, received.data(), 1, MPI_INT, communicator.handle());
  for (std::size_t r = 1; r < ranks; ++r) {
    sent_at[r] = sent_at[r - 1] + sent[r - 1];
    received_at[r] = received_at[r - 1] + received[r - 1];
  }
  std::vector<char> out(static_cast<std::size_t>(sent_at.back() + sent.back()));
  std::vector<char> in(static_cast<std::size_t>(received_at.back() + received.back()));
  for (std::size_t r = 0; r < ranks; ++r) {
    if (sent[r] > 0) std::memcpy(out.data() + sent_at[r], to_rank[r].data(), static_cast<std::size_t>(sent[r]));
  }
  MPI_Alltoallv(out.data(), sent.data(), sent_at.data(), MPI_BYTE, in.data(), received.data(), received_at.data(),
                MPI_BYTE, communicator.handle());
  std::vector<std::vector<T>> from_rank(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    from_rank[r].resize(static_cast<std::size_t>(received[r]) / sizeof(T));
    if (received[r] > 0)
      std::memcpy(from_rank[r].data(), in.data() + received_at[r], static_cast<std::size_t>(received[r]));
  }
  return from_rank;
}

template <class T>
std::vector<T> joined(std::vector<std::vector<T>> const& parts) {
  std::vector<T> all;
  for (auto const& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

Decomposition::Decomposition(Communicator const& communicator, double period)
    : communicator_(communicator), period_(period) {
  MPI_Comm node;
  MPI_Comm_split_type(communicator.handle(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, &ranks_on_node_);
  MPI_Comm_free(&node);
}

void Decomposition::redistribute(std::vector<GrainRecord>& grains, std::vector<std::int64_t> const& loads,
                                 std::vector<LocalSpring> const& old_springs, std::vector<ContactSpring>& springs) {
  springs.clear();
  if (size() == 1) {
    for (LocalSpring const& old : old_springs) springs.push_back(old.spring);
    return sort_springs(springs);
  }
  auto const ranks = static_cast<std::size_t>(size());
  std::vector<double> x(grains.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = grains[i].state.x;
  bool const open = !std::isfinite(period_);
  cuts_ = equal_loads(x, loads, ranks, open ? -period_ : 0.0, period_, communicator_);

  std::vector<std::size_t> target(grains.size());
  std::vector<std::vector<GrainRecord>> grains_to(ranks);
  std::vector<std::vector<ContactSpring>> springs_to(ranks);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    target[i] =
        static_cast<std::size_t>(std::upper_bound(cuts_.begin(), cuts_.end(), grains[i].state.x) - cuts_.begin()) - 1;
    grains_to[target[i]].push_back(grains[i]);
  }
  for (LocalSpring const& old : old_springs) {
    for (std::int32_t const row : {old.row_a, old.row_b}) {
      if (row >= 0 && static_cast<std::size_t>(row) < grains.size())
        springs_to[target[static_cast<std::size_t>(row)]].push_back(old.spring);
    }
  }
  grains = joined(exchange(communicator_, grains_to));
  springs = joined(exchange(communicator_, springs_to));
  sort_springs(springs);
}

void Decomposition::add_ghosts(Grains& grains, double reach) {
  if (size() == 1) return;
  auto const ranks = static_cast<std::size_t>(size());
  sent_rows_.assign(ranks, {});
  std::vector<std::vector<GrainRecord>> to_rank(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    if (static_cast<int>(r) == communicator_.rank()) continue;
    for (std::size_t i = 0; i < grains.owned; ++i) {
      if (!is_within(grains[i].x, cuts_[r] - reach, cuts_[r + 1] + reach)) continue;
      sent_rows_[r].push_back(static_cast<std::int32_t>(i));
      to_rank[r].push_back(grains.record(i));
    }
  }
  auto const from_rank = exchange(communicator_, to_rank);
  received_.clear();
  std::size_t sent = 0, received = 0;
  for (std::size_t r = 0; r < ranks; ++r) {
    for (GrainRecord const& record : from_rank[r]) grains.push_back(record);
    received_.push_back(from_rank[r].size());
    received += from_rank[r].size();
    sent += to_rank[r].size();
  }
  send_buffer_.resize(sent);
  receive_buffer_.resize(received);
  requests_.reserve(2 * ranks);
}

void Decomposition::update_ghosts(Grains& grains) {
  if (size() == 1) return;
  requests_.clear();
  GrainState* in = receive_buffer_.data();
  GrainState* out = send_buffer_.data();
  constexpr std::size_t values = sizeof(GrainState) / sizeof(double);
  for (std::size_t r = 0; r < received_.size(); ++r) {
    if (received_[r] == 0) continue;
    MPI_Irecv(in, static_cast<int>(received_[r] * values), MPI_DOUBLE, static_cast<int>(r), 0, communicator_.handle(),
              &requests_.emplace_back());
    in += received_[r];
  }
  for (std::size_t r = 0; r < sent_rows_.size(); ++r) {
    if (sent_rows_[r].empty()) continue;
    GrainState* at = out;
    for (std::int32_t const row : sent_rows_[r]) *at++ = grains[static_cast<std::size_t>(row)];
    MPI_Isend(out, static_cast<int>(sent_rows_[r].size() * values), MPI_DOUBLE, static_cast<int>(r), 0,
              communicator_.handle(), &requests_.emplace_back());
    out = at;
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  std::ranges::copy(receive_buffer_, grains.state.begin() + static_cast<std::ptrdiff_t>(grains.owned));
}

void Decomposition::update_ghost_sleep(Grains& grains) const {
  if (size() == 1) return;
  std::vector<std::vector<std::int32_t>> to_rank(sent_rows_.size());
  for (std::size_t r = 0; r < sent_rows_.size(); ++r)
    for (std::int32_t const row : sent_rows_[r]) to_rank[r].push_back(grains.quiet[static_cast<std::size_t>(row)]);
  std::ranges::copy(joined(exchange(communicator_, to_rank)),
                    grains.quiet.begin() + static_cast<std::ptrdiff_t>(grains.owned));
}

bool Decomposition::is_within(double x, double low, double high) const {
  if (x >= low && x <= high) return true;
  return std::isfinite(period_) &&
         ((x + period_ >= low && x + period_ <= high) || (x - period_ >= low && x - period_ <= high));
}

}  // namespace layerloop::dem
