#include <algorithm>
#include <array>
#include <cmath>

#include "core/bed_text.hpp"

namespace layerloop {
namespace {

/// One entry of Properties, as name:type:count, and the column where it begins.
struct Property {
  std::string_view name;
  std::size_t first, count;
};

std::vector<Property> read_properties(BedText const& text, std::string_view line, std::size_t& columns) {
  auto const list = value_of(line, "Properties");
  if (!list) text.refuse("no Properties in the second line (extxyz names its columns there) add Properties=...");
  std::vector<std::string_view> const words = words_of(*list, ':');
  if (words.size() % 3 != 0) text.refuse("Properties={} (entries are name:type:count) correct it", *list);
  std::vector<Property> properties;
  columns = 0;
  for (std::size_t w = 0; w < words.size(); w += 3) {
    std::int64_t const count = text.whole_number(words[w + 2], "count of a property");
    if (count < 1 || count > 100) text.refuse("a property of {} columns (1 to 100) correct Properties", count);
    properties.push_back({words[w], columns, static_cast<std::size_t>(count)});
    columns += static_cast<std::size_t>(count);
  }
  return properties;
}

Property const* find(std::vector<Property> const& properties, std::initializer_list<std::string_view> names,
                     std::size_t count) {
  auto const found = std::ranges::find_if(properties, [&](Property const& p) {
    return p.count == count && std::ranges::find(names, p.name) != names.end();
  });
  return found == properties.end() ? nullptr : &*found;
}

void read_cell(BedText const& text, std::string_view line, BedFile& file) {
  auto const lattice = value_of(line, "Lattice");
  if (!lattice) return;
  std::vector<std::string_view> const words = words_of(*lattice),
                                      flags = words_of(value_of(line, "pbc").value_or("T T T"));
  if (words.size() != 9 || flags.size() != 3)
    text.refuse("Lattice or pbc is not complete (9 numbers, 3 letters) correct it");
  for (std::size_t k = 0; k < 9; ++k) {
    if (k % 4 != 0 && text.number(words[k], "Lattice") != 0)
      text.refuse("the lattice is tilted (only right-angled ones are read) give a diagonal Lattice");
  }
  auto const periodic = [&](std::size_t axis) { return flags[axis].starts_with('T') || flags[axis] == "1"; };
  if (periodic(0)) file.periodic_x = text.number(words[0], "Lattice");
  if (periodic(1)) file.periodic_y = text.number(words[4], "Lattice");
}

GrainRow read_row(BedText const& text, std::string_view line, std::vector<Property> const& properties,
                  std::size_t columns, std::size_t index) {
  std::vector<std::string_view> const words = words_of(line);
  if (words.size() != columns)
    text.refuse("{} values in a row (Properties names {}) correct the line", words.size(), columns);
  auto const vector = [&](Property const* p) {
    if (!p) return Vec3(0, 0, 0);
    auto const value = [&](std::size_t c) { return text.number(words[p->first + c], p->name); };
    return Vec3(value(0), value(1), value(2));
  };
  Property const* const radius = find(properties, {"radius"}, 1);
  Property const *const id = find(properties, {"id"}, 1), *const material = find(properties, {"material"}, 1);
  GrainRow row;
  row.id = id ? text.whole_number(words[id->first], "id") : static_cast<std::int64_t>(index);
  row.position = vector(find(properties, {"pos"}, 3));
  row.velocity = vector(find(properties, {"velo", "vel", "velocity"}, 3));
  row.spin = vector(find(properties, {"angular_velocity"}, 3));
  row.radius = text.number(words[radius->first], "radius");
  row.material = material ? static_cast<std::int32_t>(text.whole_number(words[material->first], "material")) : 0;
  row.line = text.line();
  check_row(text, row);
  return row;
}

/// \param first_line  of the frame: its number of grains
BedFile read_frame(BedText& text, std::string_view first_line, bool keep) {
  BedFile file;
  std::int64_t const grains = text.whole_number(first_line, "number of grains");
  std::string_view const header = text.require("the line of Properties");
  std::size_t columns = 0;
  std::vector<Property> const properties = read_properties(text, header, columns);
  if (!find(properties, {"pos"}, 3) || !find(properties, {"radius"}, 1))
    text.refuse("no pos:R:3 or no radius:R:1 in Properties (a grain needs both) add them");
  read_cell(text, header, file);
  if (auto const word = value_of(header, "floor_z")) file.floor_z = text.number(*word, "floor_z");
  if (auto const word = value_of(header, "density")) file.density = text.number(*word, "density");
  std::vector<GrainRow> rows;
  for (std::int64_t k = 0; k < grains; ++k) {
    std::string_view const row = text.require(fmt::format("row {} of {} grains", k + 1, grains));
    if (keep) rows.push_back(read_row(text, row, properties, columns, static_cast<std::size_t>(k)));
  }
  file.bed = bed_of(text, std::move(rows));
  return file;
}

std::int64_t count_frames(BedText text) {
  std::int64_t frames = 0;
  while (auto const line = text.next()) frames += value_of(*line, "Properties").has_value();
  return frames;
}
}  // namespace

BedFile read_bed_extxyz(BedText text, std::optional<std::int64_t> frame) {
  std::int64_t const frames = std::max<std::int64_t>(count_frames(text), 1), wanted = frame.value_or(frames - 1);
  if (wanted < 0 || wanted >= frames)
    text.refuse("frame {} of a file with {} (frames count from 0) choose another", wanted, frames);
  for (std::int64_t k = 0;; ++k) {
    std::string_view const first_line = text.require("a frame");
    BedFile file = read_frame(text, first_line, k == wanted);
    if (k == wanted) return file;
  }
}

std::string bed_as_extxyz(BedFile const& file) {
  PowderBed const& bed = file.bed;
  BedBox const box = box_of(file);
  Vec3 const size = box.high - box.low;
  std::string text = fmt::format(
      "{}\nLattice=\"{:.17g} 0 0 0 {:.17g} 0 0 0 {:.17g}\" Origin=\"{:.17g} {:.17g} {:.17g}\" pbc=\"{} {} F\" "
      "Properties=species:S:1:pos:R:3:radius:R:1:id:I:1:material:I:1:velo:R:3:angular_velocity:R:3 units=m",
      bed.size(), size.x(), size.y(), size.z(), box.low.x(), box.low.y(), box.low.z(), file.periodic_x ? 'T' : 'F',
      file.periodic_y ? 'T' : 'F');
  if (file.floor_z) text += fmt::format(" floor_z={:.17g}", *file.floor_z);
  if (file.density) text += fmt::format(" density={:.17g}", *file.density);
  text += '\n';
  for (std::size_t i = 0; i < bed.size(); ++i)
    fmt::format_to(std::back_inserter(text),
                   "X {:.17g} {:.17g} {:.17g} {:.17g} {} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n",
                   bed.x[i], bed.y[i], bed.z[i], bed.radius[i], bed.id[i], bed.material[i], bed.vx[i], bed.vy[i],
                   bed.vz[i], bed.wx[i], bed.wy[i], bed.wz[i]);
  return text;
}

}  // namespace layerloop
