#pragma once
#include <stdexcept>
#include <string>

namespace layerloop {

/// Exit codes that scripts rely on.
enum class ExitCode { done = 0, bad_input = 2, physics_guard = 3, file_trouble = 4, stopped_by_signal = 5, bug = 70 };

/// Base of everything that is meant for the user's eyes. Message shape: "problem (why it is one) suggestion".
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, std::string const& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// What the user wrote cannot be run; thrown before any computing.
class InputError : public Error {
 public:
  explicit InputError(std::string const& message) : Error(ExitCode::bad_input, message) {}
};

/// A run became unphysical (lost particle, excessive overlap, NaN, ledger that does not close); names the remedy.
class PhysicsError : public Error {
 public:
  explicit PhysicsError(std::string const& message) : Error(ExitCode::physics_guard, message) {}
};

/// A file could not be read or written.
class FileError : public Error {
 public:
  explicit FileError(std::string const& message) : Error(ExitCode::file_trouble, message) {}
};

/// A signal asked for an early end; the last checkpoint is on disk.
class StoppedBySignal : public Error {
 public:
  explicit StoppedBySignal(std::string const& message) : Error(ExitCode::stopped_by_signal, message) {}
};

}  // namespace layerloop
