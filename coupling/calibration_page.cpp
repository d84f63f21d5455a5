// The report of the verb calibrate: one HTML file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/calibration_fit.hpp"
#include "coupling/calibration_output.hpp"
#include "coupling/program_version.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/svg_map.hpp"
#include "coupling/report/svg_plot.hpp"
#include "report_assets.hpp"

namespace layerloop::coupling {
namespace {
constexpr double degree = std::numbers::pi / 180;
constexpr int cells = 90;  // of a map along friction

std::string bytes_of(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

/// Friction along x, cohesion along y in a power of ten of J/m3 that makes both ranges alike.
struct MapAxes {
  explicit MapAxes(CalibrateSettings const& c) : friction(*c.friction), cohesion(*c.cohesion) {
    double const ratio = (cohesion[1] - cohesion[0]) / (friction[1] - friction[0]);
    unit = std::pow(10.0, std::round(std::log10(ratio)));
    cell = (friction[1] - friction[0]) / cells;
    rows = std::max(1, static_cast<int>(std::lround((cohesion[1] - cohesion[0]) / unit / cell)));
  }
  double u(int i) const { return -1 + 2 * (i + 0.5) / cells; }
  double v(int j) const { return -1 + 2 * (j + 0.5) / rows; }
  std::string cohesion_label() const { return fmt::format("cohesion energy density [{:.0e} J/m3]", unit); }
  std::array<double, 2> friction, cohesion;
  double unit, cell;
  int rows;
};

std::string angle_map(Calibration const& found, CalibrateSettings const& c, bool repose) {
  MapAxes const axes(c);
  AngleSurfaces const fitted(found.points, c);
  ResponseSurface const& surface = repose ? fitted.repose : fitted.slip;
  double const target = (repose ? c.target_repose : c.target_slip) / degree;
  Raster map{axes.friction[0], axes.cohesion[0] / axes.unit, axes.cell, cells, axes.rows, {}};
  for (int j = 0; j < map.ny; ++j)
    for (int i = 0; i < map.nx; ++i) map.values.push_back(surface(axes.u(i), axes.v(j)) / degree);
  auto const [low, high] = std::ranges::minmax_element(map.values);
  ColourScale const scale{.map = ColourMap::height,
                          .label = repose ? "angle of repose [deg]" : "slipping angle [deg]",
                          .low = std::min(*low, target - 1),
                          .high = std::max(*high, target + 1),
                          .mark = target,
                          .mark_label = "measured"};
  Outline const band{[&](int i, int j) { return std::abs(map.at(i, j) / target - 1) <= c.tolerance; }, "outline"};
  return map_plot(map, scale, "friction", axes.cohesion_label(), {band}, 520);
}

std::string maps(Calibration const& found, CalibrateSettings const& c) {
  if (found.map_points == 0) return "";
  return "<h2>The map</h2>\n" +
         figure(
             angle_map(found, c, true) + angle_map(found, c, false),
             fmt::format("Second-order surfaces through the {} points below, weighted towards the best one. Inside the "
                         "line the angle is within {:g} % of the measured one.",
                         found.points.size(), 100 * c.tolerance),
             "points.csv");
}

std::string angle_cell(MeasuredAngle const& angle) {
  return with_uncertainty(angle.value / degree, angle.u() / degree);
}

std::string points_table(Calibration const& found) {
  std::string rows;
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    CalibrationPoint const& p = found.points[k];
    rows += fmt::format(
        "<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        k == found.best ? " class=\"total\"" : "", chosen(p.parameters.sliding_friction),
        significant(p.parameters.cohesion_energy_density, 4), chosen(p.parameters.wall_friction), angle_cell(p.repose),
        p.slipped() ? angle_cell(p.slip) : fmt::format("none up to {:.0f}", p.largest_tilt / degree),
        significant(p.repose_from_height.value / degree), significant(p.tilt_at_one_diameter.value / degree));
  }
  return "<h2>The points</h2>\n<table><thead><tr><th>friction</th><th>cohesion [J/m3]</th><th>wall friction</th>"
         "<th>angle of repose [deg]</th><th>slipping angle [deg]</th><th>arctan(h / (d/2)) [deg]</th>"
         "<th>tilt at one diameter [deg]</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string first_bed(FirstBed const& first) {
  LinePlot pile{.x_label = "distance from the axis [um]", .y_label = "height [um]", .series = {}, .from_zero = true};
  for (dem::PileProfile const& p : first.profiles) {
    Series& s = pile.series.emplace_back();
    s.name = fmt::format("{:.0f} deg", p.direction / degree);
    for (std::size_t k = 0; k < p.radius.size(); ++k) {
      s.x.push_back(p.radius[k] * 1e6);
      s.y.push_back(p.height[k] * 1e6);
    }
  }
  Series speed{.name = "speed", .x = {}, .y = {}};
  for (dem::TiltSample const& s : first.record) {
    speed.x.push_back(s.tilt / degree);
    speed.y.push_back(s.speed * 1e3);
  }
  LinePlot const plate{.x_label = "tilt [deg]", .y_label = "mean speed [mm/s]", .series = {speed}, .from_zero = true};
  return "<h2>The case's own values</h2>\n" +
         figure(line_plot(pile), "The surface of the pile along eight lines from its axis outwards.",
                "pile_profiles.csv") +
         figure(line_plot(plate), "The layer on the plate while it is tilted.", "tilt.csv");
}

std::string sensitivity_tables(Calibration const& found) {
  if (!found.sensitivity) return "";
  Sensitivity const& s = *found.sensitivity;
  std::string rows, list;
  for (std::size_t p = 0; p < ContactParameters::count; ++p)
    rows +=
        fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", ContactParameters::names()[p],
                    with_uncertainty(s.slope[0][p], s.slope_u[0][p]), with_uncertainty(s.slope[1][p], s.slope_u[1][p]));
  for (Undetermined const& u : s.undetermined) list += fmt::format("<li>{}</li>\n", escape(u.text));
  return "<h2>What the two tests cannot tell apart</h2>\n<p>Two angles hold two combinations of five parameters at "
         "most. Relative change of either angle over that of a parameter, at the best point:</p>\n"
         "<table><thead><tr><th>parameter</th><th>angle of repose</th><th>slipping angle</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n<ul>\n" + list + "</ul>\n";
}
}  // namespace

std::string calibration_page(Case const& checked, Calibration const& found) {
  std::string const body =
      maps(found, checked.calibrate) + points_table(found) + first_bed(found.first) + sensitivity_tables(found);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
      "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'sha256-{}'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{} &ndash; "
      "calibration</title>\n<style>{}</style>\n</head>\n<body>\n<header>\n<div class=\"page\">\n<p "
      "class=\"program\">layerloop {} &middot; seed {}</p>\n<h1>{}</h1>\n<p class=\"lead\">{}</p>\n</div>\n</header>\n"
      "<main class=\"page\">\n{}</main>\n</body>\n</html>\n",
      base64(bytes_of(report_css_sha256)), escape(checked.name), report_css, program_version(), checked.seed,
      escape(checked.name), escape(found.verdict), body);
}

}  // namespace layerloop::coupling
