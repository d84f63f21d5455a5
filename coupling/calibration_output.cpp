#include "coupling/calibration_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/program_version.hpp"

namespace layerloop::coupling {
namespace {
using nlohmann::json;
namespace fs = std::filesystem;
constexpr double degree = std::numbers::pi / 180;

void add_angle(json& to, std::string const& name, MeasuredAngle const& angle) {
  to[name] = number(angle.value / degree);
  to[name + "_u_num"] = number(angle.u_num / degree);
  if (angle.n > 1) to[name + "_u_bed"] = number(angle.u_bed / degree);
  to[name + "_n"] = angle.n;
}

json parameters(std::array<double, ContactParameters::count> const& values) {
  json named;
  for (std::size_t p = 0; p < values.size(); ++p) named[ContactParameters::names()[p]] = number(values[p]);
  return named;
}

json point(CalibrationPoint const& p, CalibrateSettings const& c) {
  json entry{{"parameters", parameters(p.parameters.values())},
             {"slipped", p.slipped()},
             {"largest_tilt", p.largest_tilt / degree},
             {"grains_on_base", p.grains_on_base},
             {"settling_time", p.settling_time}};
  add_angle(entry, "angle_of_repose", p.repose);
  add_angle(entry, "slipping_angle", p.slip);
  add_angle(entry, "angle_of_repose_from_height", p.repose_from_height);
  add_angle(entry, "tilt_at_one_diameter", p.tilt_at_one_diameter);
  auto const [repose, slip] = p.errors(c);
  entry["relative_error_repose"] = repose;
  entry["relative_error_slip"] = slip;
  return entry;
}

json sensitivity(Sensitivity const& s) {
  return {{"angle_of_repose", parameters(s.slope[0])},
          {"angle_of_repose_u", parameters(s.slope_u[0])},
          {"slipping_angle", parameters(s.slope[1])},
          {"slipping_angle_u", parameters(s.slope_u[1])},
          {"singular_values", s.singular_values}};
}

json definitions() {
  return {
      {"angle_of_repose",
       "mean slope of the pile: line through five equally spaced surface points from 0.1 to 0.85 of the base's radius, "
       "four lines through the axis, both halves [deg]"},
      {"angle_of_repose_from_height", "arctan(h / (d / 2)), h over the axis of the base, d its diameter [deg]"},
      {"slipping_angle",
       "arctan of the friction that balances the layer's momentum while its mean speed goes from 5 to 20 mm/s: the "
       "tilt "
       "at which the layer as a whole begins to slide; null when it does not slip [deg]"},
      {"tilt_at_one_diameter",
       "tilt at which the grains have moved by one mean diameter on average: what an eye calls slipping; it rises with "
       "calibrate.tilt_rate [deg]"},
      {"*_u_num", "half the 95 % interval from the scatter within a bed (profiles of a pile, parts of a slip)"},
      {"*_u_bed", "half the 95 % t-interval over replicates, *_n of them"},
      {"undetermined",
       "changes of the parameters (relative) that the two angles cannot tell from none, to first order"},
      {"sensitivity", "d ln(angle) / d ln(parameter), one parameter at a time; grains and walls apart"},
      {"singular_values", "of the sensitivities over the relative uncertainty of their angle"},
  };
}

json summary(Case const& checked, Calibration const& found) {
  CalibrateSettings const& c = checked.calibrate;
  CalibrationPoint const& best = found.points[found.best];
  json all{{"verb", "calibrate"}, {"case", checked.name}, {"seed", checked.seed}, {"version", program_version()}};
  all.update(point(best, c));
  all["targets"] = {{"angle_of_repose", c.target_repose / degree},
                    {"slipping_angle", c.target_slip / degree},
                    {"tolerance", c.tolerance}};
  all["target_reached"] = found.target_reached;
  all["verdict"] = found.verdict;
  all["undetermined"] = json::array();
  if (found.sensitivity) {
    for (Undetermined const& u : found.sensitivity->undetermined)
      all["undetermined"].push_back({{"text", u.text}, {"change", parameters(u.change)}});
    all["sensitivity"] = sensitivity(*found.sensitivity);
  }
  all["points"] = json::array();
  for (CalibrationPoint const& p : found.points) all["points"].push_back(point(p, c));
  all["wall_time"] = {{"dem", found.wall_time}, {"total", found.wall_time}};
  all["definitions"] = definitions();
  return all;
}

std::string points_csv(Calibration const& found) {
  std::string text =
      "sliding_friction,rolling_friction,cohesion_energy_density [J/m3],wall_friction,wall_cohesion [J/m3],"
      "angle_of_repose [deg],u(angle_of_repose) [deg],slipping_angle [deg],u(slipping_angle) [deg],"
      "angle_of_repose_from_height [deg],tilt_at_one_diameter [deg],grains_on_base,beds\n";
  for (CalibrationPoint const& p : found.points) {
    for (double const value : p.parameters.values()) text += fmt::format("{:.6g},", value);
    for (MeasuredAngle const& angle : {p.repose, p.slip})
      text += fmt::format("{:.4f},{:.4f},", angle.value / degree, angle.u() / degree);
    text += fmt::format("{:.4f},{:.4f},{:.0f},{}\n", p.repose_from_height.value / degree,
                        p.tilt_at_one_diameter.value / degree, p.grains_on_base, p.repose.n);
  }
  return text;
}

std::string profiles_csv(FirstBed const& first) {
  std::string text = "direction [deg],r [um],height [um]\n";
  for (dem::PileProfile const& p : first.profiles)
    for (std::size_t k = 0; k < p.radius.size(); ++k)
      text += fmt::format("{:.0f},{:.4f},{:.4f}\n", p.direction / degree, p.radius[k] * 1e6, p.height[k] * 1e6);
  return text;
}

std::string tilt_csv(FirstBed const& first) {
  std::string text = "time [ms],tilt [deg],speed [mm/s],displacement [um]\n";
  for (dem::TiltSample const& s : first.record)
    text += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}\n", s.time * 1e3, s.tilt / degree, s.speed * 1e3,
                        s.displacement * 1e6);
  return text;
}
}  // namespace

void write_calibration(fs::path const& folder, Case const& checked, Calibration const& found) {
  write_file(folder / "case_resolved.toml", resolved_toml(checked));
  write_file(folder / "points.csv", points_csv(found));
  write_file(folder / "pile_profiles.csv", profiles_csv(found.first));
  write_file(folder / "tilt.csv", tilt_csv(found.first));
  write_file(folder / "report.html", calibration_page(checked, found));
  write_file(folder / "summary.json", summary(checked, found).dump(2) + "\n");
}

}  // namespace layerloop::coupling
