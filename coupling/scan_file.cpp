#include "coupling/scan_file.hpp"

#include <optional>

#include "core/bed_text.hpp"
#include "core/write_file.hpp"

namespace layerloop::coupling {
namespace {

enum class LastColumn { speed, time };

LastColumn read_header(BedText& text) {
  std::string_view const header = text.require("the header");
  if (header == "x [um],y [um],power [W],speed [mm/s]") return LastColumn::speed;
  if (header == "x [um],y [um],power [W],time [us]") return LastColumn::time;
  text.refuse(
      "header \"{}\" (must be \"x [um],y [um],power [W],speed [mm/s]\", or \"time [us]\" in the place of the speed)",
      header);
}

/// A row in SI.
struct Point {
  Vec3 at;
  double power, last;
};

Point read_point(BedText const& text, std::string_view line, LastColumn column) {
  std::vector<std::string_view> const words = words_of(line, ',');
  if (words.size() != 4) text.refuse("{} values (four are needed: x, y, power, speed or time)", words.size());
  Point const point{.at = {1e-6 * text.number(words[0], "x"), 1e-6 * text.number(words[1], "y"), 0},
                    .power = text.number(words[2], "power"),
                    .last = (column == LastColumn::speed ? 1e-3 : 1e-6) * text.number(words[3], "speed or time")};
  if (point.power < 0) text.refuse("power {} W (must not be negative)", point.power);
  return point;
}

}  // namespace

std::vector<Track> read_scan_file(std::filesystem::path const& path) {
  BedText text(path, read_file(path));
  LastColumn const column = read_header(text);
  std::vector<Track> tracks;
  std::optional<Point> from;
  double time = 0, start = 0;
  while (std::optional<std::string_view> const line = text.next()) {
    if (line->empty() || line->starts_with('#')) continue;
    Point const to = read_point(text, *line, column);
    if (!from) start = to.last;
    if (from) {
      double const way = (to.at - from->at).norm();
      if (column == LastColumn::speed && to.last <= 0 && way > 0)
        text.refuse("speed {:g} mm/s (must be above 0 to get there)", 1e3 * to.last);
      double const arrival = column == LastColumn::time ? to.last - start : time + (way > 0 ? way / to.last : 0.0);
      if (arrival < time) text.refuse("time {:g} us (must not descend)", 1e6 * to.last);
      if (to.power > 0) {
        if (way == 0 || arrival == time)
          text.refuse("the beam is on without moving, or moves in no time (a track has a length and a speed)");
        tracks.push_back({from->at, to.at, time, arrival, to.power});
      }
      time = arrival;
    }
    from = to;
  }
  if (tracks.empty()) text.refuse("the beam is never on (no row after the first has power) give a track");
  return tracks;
}

}  // namespace layerloop::coupling
