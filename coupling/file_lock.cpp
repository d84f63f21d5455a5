#include "coupling/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
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

bool locked(int file, FileLock::Wait wait) {
  while (::flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EINTR && (wait == FileLock::Wait::no || stop_requested())) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return true;
}

}  // namespace

FileLock::FileLock(std::filesystem::path const& path, Wait wait) : file_(opened(path)), held_(locked(file_, wait)) {}

FileLock::~FileLock() { ::close(file_); }

}  // namespace layerloop::coupling
