#include "core/ply_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <string_view>

#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read as little-endian");

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::map<std::string_view, Scalar> const scalar_names = {
    {"char", Scalar::int8},      {"int8", Scalar::int8},       {"uchar", Scalar::uint8},
    {"uint8", Scalar::uint8},    {"short", Scalar::int16},     {"int16", Scalar::int16},
    {"ushort", Scalar::uint16},  {"uint16", Scalar::uint16},   {"int", Scalar::int32},
    {"int32", Scalar::int32},    {"uint", Scalar::uint32},     {"uint32", Scalar::uint32},
    {"float", Scalar::float32},  {"float32", Scalar::float32}, {"double", Scalar::float64},
    {"float64", Scalar::float64}};

struct Property {
  std::string name;
  Scalar type;
  bool is_list = false;
  Scalar count_type = Scalar::uint8;
};

struct Element {
  std::string name;
  std::int64_t count;
  std::vector<Property> properties;
};

/// Header lines and values of one file, with the place for messages.
class PlyReader {
 public:
  PlyReader(std::string_view bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

  TriangleSurface read() {
    read_header();
    for (Element const& element : elements_)
      for (std::int64_t row = 0; row < element.count; ++row) read_row(element, row);
    if (surface_.triangles.empty()) fail("no triangle in it");
    return merged();
  }

 private:
  [[noreturn]] void fail(std::string const& what) const { throw InputError(fmt::format("{}: {}", file_, what)); }

  std::vector<std::string_view> header_line() {
    std::size_t const end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) fail("PLY header without end_header (damaged file) export the mesh again");
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    std::vector<std::string_view> words;
    while (true) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
      if (line.empty()) return words;
      words.push_back(line.substr(0, line.find_first_of(" \t\r")));
      line.remove_prefix(words.back().size());
    }
  }

  Scalar scalar(std::string_view word) const {
    auto const found = scalar_names.find(word);
    if (found == scalar_names.end()) fail(fmt::format("PLY header has the unknown type \"{}\"", word));
    return found->second;
  }

  void read_header() {
    header_line();  // "ply"
    for (auto words = header_line(); words.empty() || words[0] != "end_header"; words = header_line()) {
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format" && words.size() == 3) {
        if (words[1] == "binary_big_endian") fail("is big-endian (not read) export it as ASCII or little-endian");
        ascii_ = words[1] == "ascii";
      } else if (words[0] == "element" && words.size() == 3) {
        std::int64_t count = -1;
        std::from_chars(words[2].data(), words[2].data() + words[2].size(), count);
        if (count < 0) fail(fmt::format("PLY header announces \"{}\" of {}", words[2], words[1]));
        elements_.push_back({std::string(words[1]), count, {}});
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 3) {
        elements_.back().properties.push_back({std::string(words[2]), scalar(words[1])});
      } else if (words[0] == "property" && !elements_.empty() && words.size() == 5 && words[1] == "list") {
        elements_.back().properties.push_back({std::string(words[4]), scalar(words[3]), true, scalar(words[2])});
      } else {
        fail(fmt::format("PLY header line that is not understood, \"{} ...\"", words[0]));
      }
    }
  }

  double ascii_value() {
    at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size());
    std::size_t const end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
    std::string_view const word = bytes_.substr(at_, end - at_);
    double value = 0;
    auto const [stop, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || fault != std::errc{} || stop != word.data() + word.size())
      fail(fmt::format("a number expected in {}, found \"{}\"", place_, word.substr(0, 40)));
    at_ = end;
    return value;
  }

  template <class T>
  double binary_value() {
    if (bytes_.size() - at_ < sizeof(T)) fail(fmt::format("ends in {} (damaged file) export the mesh again", place_));
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return static_cast<double>(value);
  }

  double value(Scalar type) {
    if (ascii_) return ascii_value();
    switch (type) {
      case Scalar::int8:
        return binary_value<std::int8_t>();
      case Scalar::uint8:
        return binary_value<std::uint8_t>();
      case Scalar::int16:
        return binary_value<std::int16_t>();
      case Scalar::uint16:
        return binary_value<std::uint16_t>();
      case Scalar::int32:
        return binary_value<std::int32_t>();
      case Scalar::uint32:
        return binary_value<std::uint32_t>();
      case Scalar::float32:
        return binary_value<float>();
      case Scalar::float64:
        return binary_value<double>();
    }
    return 0;
  }

  void read_row(Element const& element, std::int64_t row) {
    place_ = fmt::format("{} {}", element.name, row + 1);
    Vec3 point = Vec3::Constant(std::nan(""));
    for (Property const& property : element.properties) {
      if (property.is_list) {
        std::vector<double> list(static_cast<std::size_t>(std::clamp(value(property.count_type), 0.0, 1e6)));
        for (double& entry : list) entry = value(property.type);
        if (element.name == "face" && property.name.starts_with("vertex_ind")) add_polygon(list);
        continue;
      }
      double const number = value(property.type);
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
        point[property.name[0] - 'x'] = number + 0.0;  // -0 and 0 are one place
    }
    if (element.name != "vertex") return;
    if (!point.allFinite()) fail(fmt::format("{} has no finite x, y, z", place_));
    surface_.vertices.push_back(point);
  }

  void add_polygon(std::vector<double> const& corners) {
    if (corners.size() < 3) fail(fmt::format("{} has {} corners (at least 3)", place_, corners.size()));
    for (double const corner : corners) {
      if (!(corner >= 0 && corner < static_cast<double>(surface_.vertices.size())))
        fail(fmt::format("{} names corner {} (there are {})", place_, corner, surface_.vertices.size()));
    }
    auto const index = [&](std::size_t c) { return static_cast<std::int32_t>(corners[c]); };
    for (std::size_t c = 2; c < corners.size(); ++c) surface_.triangles.push_back({index(0), index(c - 1), index(c)});
  }

  /// Equal corners become one.
  TriangleSurface merged() {
    std::map<std::array<double, 3>, std::int32_t> place_of;
    TriangleSurface result;
    std::vector<std::int32_t> now(surface_.vertices.size());
    for (std::size_t v = 0; v < now.size(); ++v) {
      Vec3 const& p = surface_.vertices[v];
      auto const [at, is_new] = place_of.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::int32_t>(place_of.size()));
      if (is_new) result.vertices.push_back(p);
      now[v] = at->second;
    }
    for (auto const& t : surface_.triangles) {
      std::array<std::int32_t, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = now[static_cast<std::size_t>(t[c])];
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
        fail(fmt::format("triangle {} has two equal corners (it has no area); remove it", result.triangles.size() + 1));
      result.triangles.push_back(corners);
    }
    return result;
  }

  std::string_view bytes_;
  std::string file_, place_;
  std::size_t at_ = 0;
  bool ascii_ = true;
  std::vector<Element> elements_;
  TriangleSurface surface_;
};

}  // namespace

TriangleSurface read_ply(std::filesystem::path const& path) {
  std::string const bytes = read_file(path);
  if (!bytes.starts_with("ply")) throw InputError(fmt::format("{}: does not begin with \"ply\"", path.string()));
  return PlyReader(bytes, path.string()).read();
}

void write_ply(TriangleSurface const& surface, std::filesystem::path const& path) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment layerloop surface, lengths in metres\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      surface.vertices.size(), surface.triangles.size());
  auto const append = [&](void const* data, std::size_t size) { bytes.append(static_cast<char const*>(data), size); };
  for (Vec3 const& v : surface.vertices) append(v.data(), 3 * sizeof(double));
  for (auto const& t : surface.triangles) {
    bytes += '\3';
    append(t.data(), sizeof t);
  }
  write_file(path, bytes);
}

TriangleSurface read_surface(std::filesystem::path const& path) {
  return read_file(path).starts_with("ply") ? read_ply(path) : read_stl(path);
}

}  // namespace layerloop
