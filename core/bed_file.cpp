#include "core/bed_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/bed_text.hpp"
#include "core/vtkhdf.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {
constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  std::size_t const from = text.find_first_not_of(blanks);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(blanks) - from + 1);
}

BedFormat format_of(std::string_view text) {
  if (text.starts_with("\x89HDF")) return BedFormat::h5;
  if (text.starts_with("ITEM:")) return BedFormat::dump;
  std::size_t const end = text.find('\n');
  std::string_view const first = trimmed(text.substr(0, end));
  bool const count = !first.empty() && first.find_first_not_of("0123456789") == std::string_view::npos;
  return count ? BedFormat::extxyz : BedFormat::csv;
}
}  // namespace

std::optional<std::string_view> BedText::next() {
  if (at_ >= text_.size()) return std::nullopt;
  std::size_t const end = std::min(text_.find('\n', at_), text_.size());
  std::string_view const line = std::string_view(text_).substr(at_, end - at_);
  at_ = end + 1;
  ++line_;
  return trimmed(line);
}

std::string_view BedText::require(std::string_view what) {
  if (auto const line = next()) return *line;
  refuse("the file ends before {} (cut short) write or copy it again", what);
}

double BedText::number(std::string_view word, std::string_view what) const {
  double value = 0;
  auto const [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    refuse("{} \"{}\" is not a number (a finite one is needed) correct the line", what, word);
  return value;
}

std::int64_t BedText::whole_number(std::string_view word, std::string_view what) const {
  std::int64_t value = 0;
  auto const [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size())
    refuse("{} \"{}\" is not a whole number (one is needed) correct the line", what, word);
  return value;
}

std::vector<std::string_view> words_of(std::string_view line, char separator) {
  std::vector<std::string_view> words;
  if (separator == ' ') {
    for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
      std::size_t const end = std::min(line.find_first_of(blanks, at), line.size());
      words.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(blanks, end);
    }
    return words;
  }
  for (std::size_t at = 0; at <= line.size();) {
    std::size_t const end = std::min(line.find(separator, at), line.size());
    words.push_back(trimmed(line.substr(at, end - at)));
    at = end + 1;
  }
  return words;
}

std::optional<std::string_view> value_of(std::string_view line, std::string_view key) {
  for (std::size_t at = line.find(key); at != std::string_view::npos; at = line.find(key, at + 1)) {
    bool const begins = at == 0 || blanks.find(line[at - 1]) != std::string_view::npos;
    std::string_view rest = line.substr(at + key.size());
    if (!begins || !rest.starts_with('=')) continue;
    rest.remove_prefix(1);
    if (rest.starts_with('"')) return rest.substr(1, rest.find('"', 1) - 1);
    return rest.substr(0, rest.find_first_of(blanks));
  }
  return std::nullopt;
}

void check_row(BedText const& text, GrainRow const& row) {
  if (!(row.radius >= 1e-8 && row.radius <= 5e-3))
    text.refuse("radius {:g} m (no powder grain: 10 nm to 5 mm) lengths must be in metres", row.radius);
}

PowderBed bed_of(BedText const& text, std::vector<GrainRow> rows) {
  std::ranges::stable_sort(rows, {}, &GrainRow::id);
  auto const twice = std::ranges::adjacent_find(rows, {}, &GrainRow::id);
  if (twice != rows.end())
    text.refuse("grain {} is there twice (lines {} and {}) give every grain an id of its own", twice->id, twice->line,
                std::next(twice)->line);
  PowderBed bed;
  for (GrainRow const& row : rows) {
    bed.add(row.id, row.position, row.radius, row.material);
    bed.vx.back() = row.velocity.x(), bed.vy.back() = row.velocity.y(), bed.vz.back() = row.velocity.z();
    bed.wx.back() = row.spin.x(), bed.wy.back() = row.spin.y(), bed.wz.back() = row.spin.z();
  }
  return bed;
}

BedBox box_of(BedFile const& file) {
  PowderBed const& bed = file.bed;
  BedBox box{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t i = 0; i < bed.size(); ++i) {
    Vec3 const r = Vec3::Constant(bed.radius[i]);
    box.low = i == 0 ? Vec3(bed.position(i) - r) : Vec3(box.low.cwiseMin(bed.position(i) - r));
    box.high = i == 0 ? Vec3(bed.position(i) + r) : Vec3(box.high.cwiseMax(bed.position(i) + r));
  }
  if (file.floor_z) box.low.z() = std::min(box.low.z(), *file.floor_z);
  if (file.periodic_x) box.low.x() = 0, box.high.x() = *file.periodic_x;
  if (file.periodic_y) box.low.y() = 0, box.high.y() = *file.periodic_y;
  return box;
}

BedFile read_bed(std::filesystem::path const& path, std::optional<std::int64_t> frame) {
  if (!std::filesystem::is_regular_file(path))
    throw FileError(fmt::format("cannot read the bed {} (not a file)", path.string()));
  std::string content = read_file(path);
  BedFormat const format = format_of(content);
  BedFile file;
  if (format == BedFormat::h5) {
    file.bed = read_bed_group(Hdf5Reader(path));
  } else {
    BedText text(path, std::move(content));
    file = format == BedFormat::dump     ? read_bed_dump(std::move(text), frame)
           : format == BedFormat::extxyz ? read_bed_extxyz(std::move(text), frame)
                                         : read_bed_csv(std::move(text));
  }
  if (file.bed.size() == 0)
    throw InputError(fmt::format("{}:1: no grains (an empty bed) give at least one row", path.string()));
  return file;
}

std::string_view extension(BedFormat format) {
  constexpr std::array<std::string_view, 4> names{"csv", "dump", "extxyz", "h5"};
  return names[static_cast<std::size_t>(format)];
}

void write_bed(std::filesystem::path const& path, BedFile const& file, BedFormat format) {
  switch (format) {
    case BedFormat::csv:
      return write_file(path, bed_as_csv(file));
    case BedFormat::dump:
      return write_file(path, bed_as_dump(file));
    case BedFormat::extxyz:
      return write_file(path, bed_as_extxyz(file));
    case BedFormat::h5:
      return write_bed_file(path, file.bed, {}, {});
  }
}

}  // namespace layerloop
