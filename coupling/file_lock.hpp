#pragma once
#include <filesystem>

namespace layerloop::coupling {

/// A file that one process at a time holds (an open-file-description lock). The system lets go of it when the process
/// ends, however it ends.
class FileLock {
 public:
  enum class Wait { until_free, no };  // until it is free or a signal asks to stop

  /// \throws FileError  the file cannot be made
  FileLock(std::filesystem::path const& path, Wait wait);
  ~FileLock();
  FileLock(FileLock const&) = delete;
  FileLock& operator=(FileLock const&) = delete;

  bool held() const { return held_; }

  /// Whether someone holds the lock now.
  static bool is_held(std::filesystem::path const& path);

 private:
  int file_;
  bool held_;
};

}  // namespace layerloop::coupling
