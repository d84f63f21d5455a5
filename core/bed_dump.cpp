#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/bed_text.hpp"

namespace layerloop {
namespace {

/// Places of the columns that ITEM: ATOMS names.
using Columns = std::map<std::string, std::size_t, std::less<>>;

struct Frame {
  BedFile file;
  std::vector<GrainRow> rows;
};

Columns read_columns(BedText const& text, std::string_view line) {
  Columns columns;
  std::vector<std::string_view> const words = words_of(line);
  for (std::size_t c = 2; c < words.size(); ++c) columns.emplace(words[c], c - 2);
  for (char const* needed : {"x", "y", "z"}) {
    if (!columns.contains(needed))
      text.refuse("no column {} in the dump (plain positions are needed) dump x y z, not scaled ones", needed);
  }
  if (!columns.contains("radius") && !columns.contains("diameter"))
    text.refuse("no column radius or diameter in the dump (a grain needs one) add radius to the dump command");
  return columns;
}

GrainRow read_row(BedText const& text, std::string_view line, Columns const& columns, std::size_t index) {
  std::vector<std::string_view> const words = words_of(line);
  if (words.size() != columns.size())
    text.refuse("{} values in a row (ITEM: ATOMS names {}) correct the line", words.size(), columns.size());
  auto const value = [&](std::string_view name) {
    auto const found = columns.find(name);
    return found == columns.end() ? 0.0 : text.number(words[found->second], name);
  };
  auto const whole = [&](std::string_view name, std::int64_t otherwise) {
    auto const found = columns.find(name);
    return found == columns.end() ? otherwise : text.whole_number(words[found->second], name);
  };
  GrainRow row;
  row.id = whole("id", static_cast<std::int64_t>(index));
  row.position = {value("x"), value("y"), value("z")};
  row.velocity = {value("vx"), value("vy"), value("vz")};
  row.spin = {value("omegax"), value("omegay"), value("omegaz")};
  row.radius = columns.contains("radius") ? value("radius") : 0.5 * value("diameter");
  row.material = static_cast<std::int32_t>(whole("type", 1) - 1);
  row.line = text.line();
  check_row(text, row);
  return row;
}

/// "ITEM: BOX BOUNDS ff pp ff" and its three lines; periods count from the lower bound, which the positions lose.
void read_box(BedText& text, std::string_view line, Frame& frame, Vec3& low) {
  std::vector<std::string_view> const words = words_of(line);
  if (words.size() > 6) text.refuse("the box is tilted (only right-angled ones are read) dump an orthogonal box");
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::string_view> const bounds = words_of(text.require("the bounds of the box"));
    if (bounds.size() != 2)
      text.refuse("{} values (a box has a lower and an upper bound) correct the line", bounds.size());
    double const from = text.number(bounds[0], "lower bound"), to = text.number(bounds[1], "upper bound");
    std::size_t const flag = static_cast<std::size_t>(3 + axis);
    bool const periodic = words.size() > flag && words[flag] == "pp";
    if (!periodic || axis == 2) continue;
    low[axis] = from;
    (axis == 0 ? frame.file.periodic_x : frame.file.periodic_y) = to - from;
  }
}

/// One frame; nothing at the end of the file. \param keep  false: its rows are passed over
std::optional<Frame> read_frame(BedText& text, bool keep) {
  Frame frame;
  Vec3 low = Vec3::Zero();
  std::int64_t grains = -1;
  while (auto const line = text.next()) {
    if (line->empty()) continue;
    if (line->starts_with("ITEM: TIMESTEP")) {
      text.require("the time step");
    } else if (line->starts_with("ITEM: NUMBER OF ATOMS")) {
      grains = text.whole_number(text.require("the number of grains"), "number of grains");
    } else if (line->starts_with("ITEM: BOX BOUNDS")) {
      read_box(text, *line, frame, low);
    } else if (line->starts_with("ITEM: ATOMS")) {
      if (grains < 0) text.refuse("no ITEM: NUMBER OF ATOMS before the rows (a frame names it first) dump again");
      Columns const columns = read_columns(text, *line);
      for (std::int64_t k = 0; k < grains; ++k) {
        std::string_view const row = text.require(fmt::format("row {} of {} grains", k + 1, grains));
        if (keep) frame.rows.push_back(read_row(text, row, columns, static_cast<std::size_t>(k)));
      }
      for (GrainRow& row : frame.rows) row.position -= low;
      return frame;
    } else if (!line->starts_with("ITEM:")) {
      text.refuse("\"{}\" where an ITEM: line should stand (more rows than grains?) dump again", line->substr(0, 30));
    }
  }
  return std::nullopt;
}

std::int64_t count_frames(BedText text) {
  std::int64_t frames = 0;
  while (auto const line = text.next()) frames += line->starts_with("ITEM: ATOMS");
  return frames;
}
}  // namespace

BedFile read_bed_dump(BedText text, std::optional<std::int64_t> frame) {
  std::int64_t const frames = std::max<std::int64_t>(count_frames(text), 1), wanted = frame.value_or(frames - 1);
  if (wanted < 0 || wanted >= frames)
    text.refuse("frame {} of a dump with {} (frames count from 0) choose another", wanted, frames);
  for (std::int64_t k = 0; k < wanted; ++k) read_frame(text, false);
  std::optional<Frame> found = read_frame(text, true);
  if (!found) text.refuse("no ITEM: ATOMS in the file (not one whole frame) dump again");
  found->file.bed = bed_of(text, std::move(found->rows));
  return std::move(found->file);
}

std::string bed_as_dump(BedFile const& file) {
  PowderBed const& bed = file.bed;
  BedBox const box = box_of(file);
  std::string text = fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {} {} ff\n",
                                 bed.size(), file.periodic_x ? "pp" : "ff", file.periodic_y ? "pp" : "ff");
  for (int axis = 0; axis < 3; ++axis) text += fmt::format("{:.17g} {:.17g}\n", box.low[axis], box.high[axis]);
  text += "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n";
  for (std::size_t i = 0; i < bed.size(); ++i)
    fmt::format_to(std::back_inserter(text),
                   "{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", bed.id[i],
                   bed.material[i] + 1, bed.x[i], bed.y[i], bed.z[i], bed.radius[i], bed.vx[i], bed.vy[i], bed.vz[i],
                   bed.wx[i], bed.wy[i], bed.wz[i]);
  return text;
}

}  // namespace layerloop
