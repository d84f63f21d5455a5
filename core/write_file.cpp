#include "core/write_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.hpp"

namespace layerloop {
namespace {

void sync(std::filesystem::path const& path, int flags) {
  int const file = ::open(path.c_str(), flags);
  bool const good = file >= 0 && ::fsync(file) == 0;
  int const reason = errno;
  if (file >= 0) ::close(file);
  // Some file systems cannot sync a folder and say EINVAL; the rename is then as durable as they make it.
  if (!good && reason != EINVAL)
    throw FileError(fmt::format("cannot make {} durable ({})", path.string(), std::strerror(reason)));
}

}  // namespace

std::filesystem::path temporary_name(std::filesystem::path const& path) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  return temporary;
}

void commit_file(std::filesystem::path const& temporary, std::filesystem::path const& path) {
  sync(temporary, O_RDONLY);
  std::error_code failure;
  std::filesystem::rename(temporary, path, failure);
  if (failure) throw FileError(fmt::format("cannot rename {} ({})", temporary.string(), failure.message()));
  std::filesystem::path const folder = path.parent_path();
  sync(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

void write_file(std::filesystem::path const& path, std::string_view text) {
  std::filesystem::path const temporary = temporary_name(path);
  {
    std::ofstream file(temporary, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file)
      throw FileError(fmt::format("cannot write {} ({}); is the disk full?", temporary.string(), std::strerror(errno)));
  }
  commit_file(temporary, path);
}

std::string read_file(std::filesystem::path const& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file) throw FileError(fmt::format("cannot read {} ({})", path.string(), std::strerror(errno)));
  return text.str();
}

}  // namespace layerloop
