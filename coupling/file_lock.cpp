#include "coupling/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.hpp"

namespace layerloop::coupling {
namespace {

int opened(std::filesystem::path const& path) {
  std::error_code ignored;  // open tells what is wrong
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  int const file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) throw FileError(fmt::format("cannot lock {} ({})", path.string(), std::strerror(errno)));
  return file;
}

bool locked(int file, FileLock::Wait wait) {
  int const how = LOCK_EX | (wait == FileLock::Wait::no ? LOCK_NB : 0);
  while (::flock(file, how) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

}  // namespace

FileLock::FileLock(std::filesystem::path const& path, Wait wait) : file_(opened(path)), held_(locked(file_, wait)) {}

FileLock::~FileLock() { ::close(file_); }

}  // namespace layerloop::coupling
