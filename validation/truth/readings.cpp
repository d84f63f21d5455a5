#include "validation/truth/readings.hpp"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "core/random.hpp"

namespace layerloop::validation {
namespace {

/// Of unit variance.
double scatter(double uniform, bool heavy_tails) {
  using namespace boost::math;
  if (!heavy_tails) return quantile(normal(), uniform);
  constexpr double freedom = 5;
  return quantile(students_t(freedom), uniform) * std::sqrt((freedom - 2) / freedom);
}

}  // namespace

double standard_normal_at(std::uint64_t seed, std::uint64_t id, std::uint32_t draw) {
  return scatter(uniform4(seed, RandomStream::blind_truth, id, draw)[0], false);
}

void take_readings(Study& study, Eigen::VectorXd const& truth, ReadingErrors const& errors, std::uint64_t seed) {
  constexpr std::uint32_t groups_draw = 1000, rows_draw = 1001;
  std::map<std::string, double> shared;
  for (Observation const& row : study.observations)
    if (!row.sys_group.empty()) shared.try_emplace(row.sys_group, standard_normal_at(seed, shared.size(), groups_draw));
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation& row = study.observations[i];
    double const value = truth[static_cast<Eigen::Index>(row.observable)];
    auto const draw = uniform4(seed, RandomStream::blind_truth, i, rows_draw);
    double error = errors.noise_factor * scatter(draw[0], errors.heavy_tails);
    if (draw[1] < errors.outlier_share) error = std::copysign(6 + 2 * draw[2], draw[3] - 0.5);
    bool const omitted = !errors.omitted_group.empty() && row.sys_group == errors.omitted_group;
    bool const none = row.sys_group.empty() || row.sys_group.starts_with(group_of_beds);
    double const group = none ? 0 : shared.at(row.sys_group) * (omitted ? 2 : 1);
    row.value = value * (1 + row.u_sys_rel * group) + row.u_sys_abs * group + row.u_stat * error;
    if (omitted) row.u_sys_rel = 0, row.u_sys_abs = 0, row.sys_group.clear();
  }
}

}  // namespace layerloop::validation
