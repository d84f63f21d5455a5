#include "coupling/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/error.hpp"
#include "core/progress.hpp"

namespace layerloop::coupling {
namespace {

int opened(std::filesystem::path const& path) {
  std::error_code ignored;  // open tells what is wrong
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  int const file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) throw FileError(fmt::format("cannot lock {} ({})", path.string(), std::strerror(errno)));
  return file;
}

struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

bool locked(int file, FileLock::Wait wait) {
  struct flock lock = whole_file();
  while (::fcntl(file, F_OFD_SETLK, &lock) != 0) {
    if (errno != EINTR && (wait == FileLock::Wait::no || stop_requested())) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return true;
}

}  // namespace

FileLock::FileLock(std::filesystem::path const& path, Wait wait) : file_(opened(path)), held_(locked(file_, wait)) {}

FileLock::~FileLock() { ::close(file_); }

bool FileLock::is_held(std::filesystem::path const& path) {
  int const file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return false;
  struct flock lock = whole_file();
  bool const held = ::fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  ::close(file);
  return held;
}

}  // namespace layerloop::coupling
