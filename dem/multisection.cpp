#include "dem/multisection.hpp"

#include <algorithm>

namespace layerloop::dem {
namespace {
constexpr std::size_t parts = 64;
constexpr int rounds = 4;  // 64^4: a ten-millionth of the bed

/// Where one border may lie, and the load on its left.
struct Interval {
  double low, high;
  std::int64_t before;
};

std::size_t part_of(Interval const& interval, double x) {
  double const share = (x - interval.low) / (interval.high - interval.low);
  return std::min(static_cast<std::size_t>(share * parts), parts - 1);
}

/// Load in each part of each interval, over all ranks.
std::vector<std::int64_t> histogram(std::vector<double> const& x, std::vector<std::int64_t> const& load,
                                    std::vector<Interval> const& intervals, Communicator const& communicator) {
  std::vector<std::int64_t> sums(intervals.size() * parts, 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t r = 0; r < intervals.size(); ++r) {
      if (x[i] >= intervals[r].low && x[i] < intervals[r].high)
        sums[r * parts + part_of(intervals[r], x[i])] += load[i];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_INT64_T, MPI_SUM, communicator.handle());
  return sums;
}
}  // namespace

std::vector<double> equal_loads(std::vector<double> const& x, std::vector<std::int64_t> const& load, std::size_t slices,
                                double low, double high, Communicator const& communicator) {
  std::int64_t total = 0;
  double least = 1e300, most = -1e300;
  for (std::size_t i = 0; i < x.size(); ++i) {
    total += load[i];
    least = std::min(least, x[i]);
    most = std::max(most, x[i]);
  }
  total = communicator.sum(total);
  least = communicator.min(least);
  most = communicator.max(most);
  std::vector<Interval> intervals(slices - 1, {least, most + 1e-12, 0});
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::int64_t> const sums = histogram(x, load, intervals, communicator);
    for (std::size_t r = 0; r < intervals.size(); ++r) {
      Interval& interval = intervals[r];
      std::int64_t const wanted = total * static_cast<std::int64_t>(r + 1) / static_cast<std::int64_t>(slices);
      double const width = (interval.high - interval.low) / parts;
      std::size_t part = 0;
      while (part + 1 < parts && interval.before + sums[r * parts + part] < wanted)
        interval.before += sums[r * parts + part++];
      interval.low += static_cast<double>(part) * width;
      interval.high = interval.low + width;
    }
  }
  std::vector<double> cuts{low};
  for (Interval const& interval : intervals) cuts.push_back(interval.high);
  cuts.push_back(high);
  return cuts;
}

}  // namespace layerloop::dem
