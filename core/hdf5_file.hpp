#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace layerloop {

/// Version of every HDF5 layout that layerloop writes; read files must carry the same one.
inline constexpr int hdf5_format_version = 2;

/// A new HDF5 file, written aside (".tmp") and renamed by commit(); dropped when commit() is never reached.
/// Serial: the root rank writes. Groups on the way to a dataset are made as needed. Members throw FileError.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(std::filesystem::path path);
  ~Hdf5Writer();
  Hdf5Writer(Hdf5Writer const&) = delete;
  Hdf5Writer& operator=(Hdf5Writer const&) = delete;

  /// Shape: slowest first; its product must equal values.size(). `unit` becomes the dataset's attribute "unit" unless
  /// empty.
  void write(std::string_view dataset, std::span<double const> values, std::vector<std::uint64_t> shape,
             std::string_view unit = {});
  void write(std::string_view dataset, std::span<float const> values, std::vector<std::uint64_t> shape,
             std::string_view unit = {});
  void write(std::string_view dataset, std::span<std::int64_t const> values, std::vector<std::uint64_t> shape,
             std::string_view unit = {});
  void write(std::string_view dataset, std::span<std::int32_t const> values, std::vector<std::uint64_t> shape,
             std::string_view unit = {});
  void write(std::string_view dataset, std::span<std::uint8_t const> values, std::vector<std::uint64_t> shape,
             std::string_view unit = {});
  void attribute(std::string_view group_or_dataset, std::string_view name, std::string_view text);
  void attribute(std::string_view group_or_dataset, std::string_view name, std::vector<std::int64_t> const& values);
  void attribute(std::string_view group_or_dataset, std::string_view name, std::vector<double> const& values);
  void group(std::string_view path);

  void commit();

 private:
  std::filesystem::path path_;
  std::int64_t file_ = -1;
};

/// Reads a file that layerloop wrote. \throws FileError not readable, or of another format version
class Hdf5Reader {
 public:
  explicit Hdf5Reader(std::filesystem::path const& path);
  ~Hdf5Reader();
  Hdf5Reader(Hdf5Reader const&) = delete;
  Hdf5Reader& operator=(Hdf5Reader const&) = delete;

  bool has(std::string_view dataset) const;
  std::vector<double> read_doubles(std::string_view dataset) const;
  std::vector<float> read_floats(std::string_view dataset) const;
  std::vector<std::int64_t> read_int64(std::string_view dataset) const;
  std::vector<std::int32_t> read_int32(std::string_view dataset) const;
  std::vector<std::uint8_t> read_bytes(std::string_view dataset) const;
  std::string read_text_attribute(std::string_view group_or_dataset, std::string_view name) const;

 private:
  std::filesystem::path path_;
  std::int64_t file_ = -1;
};

}  // namespace layerloop
