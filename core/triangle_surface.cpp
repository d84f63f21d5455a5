#include "core/triangle_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "core/compensated_sum.hpp"
#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t header_bytes = 84;    // 80 free bytes and a 32-bit count
constexpr std::size_t triangle_bytes = 50;  // normal, three corners, 16-bit attribute

struct Corner {
  std::array<double, 3> xyz;
  bool operator==(Corner const&) const = default;
};

struct CornerHash {
  std::size_t operator()(Corner const& c) const {
    std::size_t hash = 0;
    for (double v : c.xyz) hash = (hash ^ std::hash<double>{}(v)) * 0x9E3779B97F4A7C15ull;
    return hash;
  }
};

/// Collects triangles given by their corners and merges corners that coincide exactly.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(std::string file) : file_(std::move(file)) {}

  void add(std::array<Corner, 3> const& corners) {
    std::array<std::int32_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (double v : corners[c].xyz) {
        if (!std::isfinite(v)) fail("has a corner that is not a finite number");
      }
      triangle[c] = vertex(corners[c]);
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      fail("has two equal corners (it has no area); remove it");
    }
    surface_.triangles.push_back(triangle);
  }

  TriangleSurface finish() {
    if (surface_.triangles.empty()) throw InputError(fmt::format("{}: no triangle in it", file_));
    return std::move(surface_);
  }

 private:
  [[noreturn]] void fail(char const* what) const {
    throw InputError(fmt::format("{}: triangle {} {}", file_, surface_.triangles.size() + 1, what));
  }

  std::int32_t vertex(Corner corner) {
    for (double& v : corner.xyz) v += 0.0;  // -0 and 0 are one place
    auto const [at, is_new] = index_.try_emplace(corner, static_cast<std::int32_t>(surface_.vertices.size()));
    if (is_new) surface_.vertices.emplace_back(corner.xyz[0], corner.xyz[1], corner.xyz[2]);
    return at->second;
  }

  std::string file_;
  TriangleSurface surface_;
  std::unordered_map<Corner, std::int32_t, CornerHash> index_;
};

std::uint32_t binary_count(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= header_bytes) std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

bool is_binary(std::string_view bytes) {
  return bytes.size() >= header_bytes &&
         header_bytes + triangle_bytes * std::uint64_t{binary_count(bytes)} == bytes.size();
}

TriangleSurface parse_binary(std::string_view bytes, std::string const& file) {
  std::uint32_t const count = binary_count(bytes);
  if (count > static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max() / 3)) {
    throw InputError(
        fmt::format("{}: {} triangles are more than layerloop can number; make the mesh coarser", file, count));
  }
  SurfaceBuilder builder(file);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> values;
    std::memcpy(values.data(), bytes.data() + header_bytes + triangle_bytes * t + 12, sizeof values);
    std::array<Corner, 3> corners;
    for (std::size_t v = 0; v < 9; ++v) corners[v / 3].xyz[v % 3] = values[v];
    builder.add(corners);
  }
  return builder.finish();
}

/// Words of an ASCII STL with their line, for messages.
class WordReader {
 public:
  WordReader(std::string_view text, std::string const& file) : text_(text), file_(file) {}

  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    std::size_t const begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  void expect(std::string_view word) {
    std::string_view const found = next();
    if (found != word) fail(fmt::format("\"{}\" expected, found \"{}\"", word, found.substr(0, 40)));
  }
  double number() {
    std::string_view const word = next();
    double value = 0;
    char const* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    auto const [end, error] = std::from_chars(begin, word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size()) {
      fail(fmt::format("a number expected, found \"{}\"", word.substr(0, 40)));
    }
    return value;
  }
  [[noreturn]] void fail(std::string const& what) const {
    throw InputError(
        fmt::format("{}:{}: {} (neither ASCII nor binary STL); export the mesh again", file_, line_, what));
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view text_;
  std::string const& file_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

TriangleSurface parse_ascii(std::string_view text, std::string const& file) {
  WordReader words(text, file);
  SurfaceBuilder builder(file);
  words.expect("solid");
  words.skip_line();
  std::string_view word = words.next();
  for (; word == "facet"; word = words.next()) {
    words.expect("normal");
    for (int c = 0; c < 3; ++c) words.number();
    words.expect("outer");
    words.expect("loop");
    std::array<Corner, 3> corners;
    for (Corner& corner : corners) {
      words.expect("vertex");
      for (double& v : corner.xyz) v = words.number();
    }
    words.expect("endloop");
    words.expect("endfacet");
    builder.add(corners);
  }
  if (word != "endsolid")
    words.fail(fmt::format("\"facet\" or \"endsolid\" expected, found \"{}\"", word.substr(0, 40)));
  return builder.finish();
}

}  // namespace

Vec3 TriangleSurface::normal(std::size_t t) const {
  return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).normalized();
}

void TriangleSurface::shift(Vec3 const& by) {
  for (Vec3& vertex : vertices) vertex += by;
}

double enclosed_volume(TriangleSurface const& surface) {
  if (surface.vertices.empty()) return 0;
  Vec3 const apex = surface.vertices.front();  // keeps the cancellation small far from the origin
  CompensatedSum six_volumes;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Vec3 const a = surface.corner(t, 0) - apex, b = surface.corner(t, 1) - apex, c = surface.corner(t, 2) - apex;
    six_volumes.add(a.dot(b.cross(c)));
  }
  return six_volumes.value() / 6;
}

std::int64_t count_open_edges(TriangleSurface const& surface) {
  std::vector<std::array<std::int32_t, 2>> edges;
  edges.reserve(3 * surface.triangles.size());
  for (auto const& t : surface.triangles) {
    for (std::size_t c = 0; c < 3; ++c) edges.push_back({t[c], t[(c + 1) % 3]});
  }
  std::sort(edges.begin(), edges.end());
  auto const count = [&](std::array<std::int32_t, 2> const& edge) {
    auto const [first, last] = std::equal_range(edges.begin(), edges.end(), edge);
    return last - first;
  };
  return std::count_if(edges.begin(), edges.end(), [&](std::array<std::int32_t, 2> const& edge) {
    return count(edge) != 1 || count({edge[1], edge[0]}) != 1;
  });
}

TriangleSurface read_stl(std::filesystem::path const& path) {
  std::string const bytes = read_file(path);
  std::string const name = path.string();
  if (is_binary(bytes)) return parse_binary(bytes, name);
  if (bytes.starts_with("solid")) return parse_ascii(bytes, name);
  if (bytes.size() < header_bytes)
    throw InputError(fmt::format("{}: {} bytes are too few for an STL file", name, bytes.size()));
  throw InputError(fmt::format(
      "{}: damaged STL file ({} triangles announced need {} bytes, it has {}); export the mesh again", name,
      binary_count(bytes), header_bytes + triangle_bytes * std::uint64_t{binary_count(bytes)}, bytes.size()));
}

void write_stl(TriangleSurface const& surface, std::filesystem::path const& path) {
  std::string bytes(header_bytes + triangle_bytes * surface.triangles.size(), '\0');
  constexpr std::string_view title = "layerloop surface, lengths in metres";
  std::copy(title.begin(), title.end(), bytes.begin());
  auto const count = static_cast<std::uint32_t>(surface.triangles.size());
  std::memcpy(bytes.data() + 80, &count, sizeof count);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<float, 12> values;
    Vec3 const n = surface.normal(t);
    for (int c = 0; c < 3; ++c) values[static_cast<std::size_t>(c)] = static_cast<float>(n[c]);
    for (int c = 0; c < 9; ++c)
      values[static_cast<std::size_t>(3 + c)] = static_cast<float>(surface.corner(t, c / 3)[c % 3]);
    std::memcpy(bytes.data() + header_bytes + triangle_bytes * t, values.data(), sizeof values);
  }
  write_file(path, bytes);
}

}  // namespace layerloop
