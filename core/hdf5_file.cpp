#include "core/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

/// An identifier of the library that is closed when it goes out of scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(Handle const&) = delete;
  Handle& operator=(Handle const&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// What the library says went wrong, from its innermost function.
std::string library_reason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, H5E_error2_t const* error, void* text) -> herr_t {
        if (depth == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
        return 0;
      },
      &reason);
  return reason.empty() ? "no reason given" : reason;
}

/// Every value that the library returns passes here: negative means that it failed.
template <class Id>
Id checked(Id returned, std::filesystem::path const& path, std::string_view what) {
  if (returned >= 0) return returned;
  std::string const reason = library_reason();
  std::string_view const remedy =
      reason.find("lock") == std::string::npos ? "" : "; on a network drive try HDF5_USE_FILE_LOCKING=FALSE";
  throw FileError(fmt::format("{}: cannot {} (HDF5: {}){}", path.string(), what, reason, remedy));
}

/// The library prints its error stack to stderr unless told not to; we put the reason into the exception.
void silence_library() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

template <class T>
hid_t native();
template <>
hid_t native<double>() {
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t native<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
hid_t native<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
hid_t native<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

Handle open_object(hid_t file, std::filesystem::path const& path, std::string const& name) {
  return {checked(H5Oopen(file, name.c_str(), H5P_DEFAULT), path, fmt::format("open \"{}\"", name)), H5Oclose};
}

void write_attribute(hid_t file, std::filesystem::path const& path, std::string const& object, std::string const& name,
                     hid_t type, hid_t space, void const* data) {
  std::string const what = fmt::format("write attribute \"{}\" of \"{}\"", name, object);
  Handle const owner = open_object(file, path, object);
  Handle const attribute{checked(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), path, what),
                         H5Aclose};
  checked(H5Awrite(attribute, type, data), path, what);
}

template <class T>
void write_attribute(hid_t file, std::filesystem::path const& path, std::string_view object, std::string_view name,
                     std::vector<T> const& values) {
  hsize_t const count = values.size();
  hid_t const id = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr);
  Handle const space{checked(id, path, "describe an attribute"), H5Sclose};
  write_attribute(file, path, std::string(object), std::string(name), native<T>(), space, values.data());
}

template <class T>
void write_dataset(hid_t file, std::filesystem::path const& path, std::string const& name, std::span<T const> values,
                   std::vector<std::uint64_t> const& shape) {
  std::uint64_t const count = std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>{});
  if (shape.empty() || count != values.size())
    throw FileError(fmt::format("{}: dataset \"{}\" has {} values but a shape for {} (a caller's mistake)",
                                path.string(), name, values.size(), count));
  std::string const what = fmt::format("write dataset \"{}\"", name);
  std::vector<hsize_t> const dims(shape.begin(), shape.end());
  Handle const space{checked(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), path, what),
                     H5Sclose};
  Handle const links{checked(H5Pcreate(H5P_LINK_CREATE), path, what), H5Pclose};
  // Without the time of creation, the same contents are the same bytes.
  Handle const creation{checked(H5Pcreate(H5P_DATASET_CREATE), path, what), H5Pclose};
  checked(H5Pset_obj_track_times(creation, false), path, what);
  checked(H5Pset_create_intermediate_group(links, 1), path, what);
  Handle const dataset{
      checked(H5Dcreate2(file, name.c_str(), native<T>(), space, links, creation, H5P_DEFAULT), path, what),
      H5Dclose};
  if (count > 0) checked(H5Dwrite(dataset, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path, what);
}

void write_text_attribute(hid_t file, std::filesystem::path const& path, std::string_view object, std::string_view name,
                          std::string_view text) {
  std::string const bytes =
      text.empty() ? std::string(1, '\0') : std::string(text);  // a string type of size 0 does not exist
  Handle const type{checked(H5Tcopy(H5T_C_S1), path, "describe a text"), H5Tclose};
  checked(H5Tset_size(type, bytes.size()), path, "describe a text");
  checked(H5Tset_strpad(type, H5T_STR_NULLPAD), path, "describe a text");
  bool const ascii =
      std::all_of(bytes.begin(), bytes.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
  checked(H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8), path, "describe a text");
  Handle const space{checked(H5Screate(H5S_SCALAR), path, "describe a text"), H5Sclose};
  write_attribute(file, path, std::string(object), std::string(name), type, space, bytes.data());
}

/// Number of values in a dataset that is stored as we store them: plainly, in this very file, all of it. Filters,
/// virtual datasets and links to other files are refused, and sizes are checked, before any memory is asked for.
std::uint64_t plain_size(hid_t file, hid_t dataset, hid_t type, std::filesystem::path const& path,
                         std::string_view name) {
  std::string const what = fmt::format("read dataset \"{}\"", name);
  auto const refuse = [&](std::string_view why) {
    throw FileError(fmt::format("{}: cannot {} ({}); was it written by another program?", path.string(), what, why));
  };
  H5O_info_t home, here;
  checked(H5Oget_info2(file, &home, H5O_INFO_BASIC), path, what);
  checked(H5Oget_info2(dataset, &here, H5O_INFO_BASIC), path, what);
  if (home.fileno != here.fileno) refuse("it is a link into another file");
  Handle const stored{checked(H5Dget_type(dataset), path, what), H5Tclose};
  if (checked(H5Tequal(stored, type), path, what) == 0) refuse("it holds another kind of number");
  Handle const creation{checked(H5Dget_create_plist(dataset), path, what), H5Pclose};
  if (checked(H5Pget_layout(creation), path, what) != H5D_CONTIGUOUS) refuse("its storage is not contiguous");
  if (checked(H5Pget_external_count(creation), path, what) != 0) refuse("its values are kept in another file");
  Handle const space{checked(H5Dget_space(dataset), path, what), H5Sclose};
  auto const count = static_cast<std::uint64_t>(checked(H5Sget_simple_extent_npoints(space), path, what));
  std::uint64_t const element = H5Tget_size(type);
  if (count > std::filesystem::file_size(path) / element || H5Dget_storage_size(dataset) != count * element)
    refuse("its size does not match what the file holds");
  return count;
}

template <class T>
std::vector<T> read_dataset(hid_t file, std::filesystem::path const& path, std::string_view name) {
  std::string const what = fmt::format("read dataset \"{}\"", name);
  Handle const dataset{checked(H5Dopen2(file, std::string(name).c_str(), H5P_DEFAULT), path, what), H5Dclose};
  std::vector<T> values(plain_size(file, dataset, native<T>(), path, name));
  if (!values.empty()) checked(H5Dread(dataset, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path, what);
  return values;
}

/// -1 when the file has none.
std::int64_t format_version_of(hid_t file, std::filesystem::path const& path) {
  if (checked(H5Aexists(file, "format_version"), path, "read its format version") == 0) return -1;
  Handle const attribute{checked(H5Aopen(file, "format_version", H5P_DEFAULT), path, "read its format version"),
                         H5Aclose};
  Handle const space{checked(H5Aget_space(attribute), path, "read its format version"), H5Sclose};
  Handle const type{checked(H5Aget_type(attribute), path, "read its format version"), H5Tclose};
  std::int64_t version = -1;
  if (H5Sget_simple_extent_npoints(space) == 1 && H5Tget_class(type) == H5T_INTEGER)
    checked(H5Aread(attribute, H5T_NATIVE_INT64, &version), path, "read its format version");
  return version;
}

}  // namespace

Hdf5Writer::Hdf5Writer(std::filesystem::path path) : path_(std::move(path)) {
  silence_library();
  file_ = checked(H5Fcreate(temporary_name(path_).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), path_,
                  "create the file");
  write_attribute<std::int64_t>(file_, path_, "/", "format_version", {hdf5_format_version});
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ < 0) return;
  H5Fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(temporary_name(path_), ignored);
}

void Hdf5Writer::write(std::string_view dataset, std::span<double const> values, std::vector<std::uint64_t> shape,
                       std::string_view unit) {
  write_dataset(file_, path_, std::string(dataset), values, shape);
  if (!unit.empty()) attribute(dataset, "unit", unit);
}
void Hdf5Writer::write(std::string_view dataset, std::span<float const> values, std::vector<std::uint64_t> shape,
                       std::string_view unit) {
  write_dataset(file_, path_, std::string(dataset), values, shape);
  if (!unit.empty()) attribute(dataset, "unit", unit);
}
void Hdf5Writer::write(std::string_view dataset, std::span<std::int64_t const> values, std::vector<std::uint64_t> shape,
                       std::string_view unit) {
  write_dataset(file_, path_, std::string(dataset), values, shape);
  if (!unit.empty()) attribute(dataset, "unit", unit);
}
void Hdf5Writer::write(std::string_view dataset, std::span<std::int32_t const> values, std::vector<std::uint64_t> shape,
                       std::string_view unit) {
  write_dataset(file_, path_, std::string(dataset), values, shape);
  if (!unit.empty()) attribute(dataset, "unit", unit);
}
void Hdf5Writer::write(std::string_view dataset, std::span<std::uint8_t const> values, std::vector<std::uint64_t> shape,
                       std::string_view unit) {
  write_dataset(file_, path_, std::string(dataset), values, shape);
  if (!unit.empty()) attribute(dataset, "unit", unit);
}

void Hdf5Writer::attribute(std::string_view object, std::string_view name, std::string_view text) {
  write_text_attribute(file_, path_, object, name, text);
}
void Hdf5Writer::attribute(std::string_view object, std::string_view name, std::vector<std::int64_t> const& values) {
  write_attribute(file_, path_, object, name, values);
}
void Hdf5Writer::attribute(std::string_view object, std::string_view name, std::vector<double> const& values) {
  write_attribute(file_, path_, object, name, values);
}

void Hdf5Writer::group(std::string_view path) {
  std::string const what = fmt::format("make group \"{}\"", path);
  Handle const links{checked(H5Pcreate(H5P_LINK_CREATE), path_, what), H5Pclose};
  checked(H5Pset_create_intermediate_group(links, 1), path_, what);
  Handle const made{checked(H5Gcreate2(file_, std::string(path).c_str(), links, H5P_DEFAULT, H5P_DEFAULT), path_, what),
                    H5Gclose};
}

void Hdf5Writer::commit() {
  // Closing writes what is still in memory, so a full disk may show only here.
  checked(H5Fflush(file_, H5F_SCOPE_LOCAL), path_, "flush the file; is the disk full?");
  checked(H5Fclose(std::exchange(file_, -1)), path_, "close the file; is the disk full?");
  commit_file(temporary_name(path_), path_);
}

Hdf5Reader::Hdf5Reader(std::filesystem::path const& path) : path_(path) {
  silence_library();
  if (!std::filesystem::is_regular_file(path))
    throw FileError(fmt::format("{}: cannot open the file (there is no such file)", path.string()));
  Handle opened{checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), path,
                        "open the file; damaged, cut short or not HDF5?"),
                H5Fclose};
  std::int64_t const version = format_version_of(opened, path);
  if (version != hdf5_format_version)
    throw FileError(fmt::format(
        "{}: {} (this program reads version {}); write it again with this version of layerloop", path.string(),
        version < 0 ? "not a file of layerloop" : fmt::format("format version {}", version), hdf5_format_version));
  file_ = H5Freopen(opened);
  checked(file_, path, "open the file");
}

Hdf5Reader::~Hdf5Reader() {
  if (file_ >= 0) H5Fclose(file_);
}

bool Hdf5Reader::has(std::string_view dataset) const {
  // H5Lexists wants every group on the way to exist, so the path is walked.
  std::string const name(dataset);
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    std::string const part = name.substr(0, end);
    if (checked(H5Lexists(file_, part.c_str(), H5P_DEFAULT), path_, "look for a dataset") == 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<double> Hdf5Reader::read_doubles(std::string_view dataset) const {
  return read_dataset<double>(file_, path_, dataset);
}
std::vector<float> Hdf5Reader::read_floats(std::string_view dataset) const {
  return read_dataset<float>(file_, path_, dataset);
}
std::vector<std::int64_t> Hdf5Reader::read_int64(std::string_view dataset) const {
  return read_dataset<std::int64_t>(file_, path_, dataset);
}
std::vector<std::int32_t> Hdf5Reader::read_int32(std::string_view dataset) const {
  return read_dataset<std::int32_t>(file_, path_, dataset);
}
std::vector<std::uint8_t> Hdf5Reader::read_bytes(std::string_view dataset) const {
  return read_dataset<std::uint8_t>(file_, path_, dataset);
}

std::string Hdf5Reader::read_text_attribute(std::string_view object, std::string_view name) const {
  std::string const what = fmt::format("read attribute \"{}\" of \"{}\"", name, object);
  Handle const owner = open_object(file_, path_, std::string(object));
  Handle const attribute{checked(H5Aopen(owner, std::string(name).c_str(), H5P_DEFAULT), path_, what), H5Aclose};
  Handle const type{checked(H5Aget_type(attribute), path_, what), H5Tclose};
  Handle const space{checked(H5Aget_space(attribute), path_, what), H5Sclose};
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || H5Sget_simple_extent_npoints(space) != 1)
    throw FileError(fmt::format("{}: cannot {} (it is not a plain text)", path_.string(), what));
  std::string text(H5Tget_size(type), '\0');
  checked(H5Aread(attribute, type, text.data()), path_, what);
  text.resize(std::strlen(text.c_str()));
  return text;
}

}  // namespace layerloop
