#pragma once
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace layerloop {

/// The ranks of one run. All members are collective unless said otherwise.
class Communicator {
 public:
  explicit Communicator(MPI_Comm comm = MPI_COMM_WORLD);

  int rank() const { return rank_; }  ///< not collective
  int size() const { return size_; }  ///< not collective
  bool is_root() const { return rank_ == 0; }
  MPI_Comm handle() const { return comm_; }

  void barrier() const;
  double max(double value) const;
  double min(double value) const;
  std::int64_t sum(std::int64_t value) const;
  bool any(bool value) const;
  /// Sum over ranks in rank order: the same bits on every rank.
  double sum(double value) const;

  void broadcast(std::string& text, int root = 0) const;

  template <class T>
  void broadcast(std::vector<T>& values, int root = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::int64_t count = static_cast<std::int64_t>(values.size());
    broadcast_bytes(&count, sizeof count, root);
    values.resize(static_cast<std::size_t>(count));
    broadcast_bytes(values.data(), values.size() * sizeof(T), root);
  }

  /// Every rank's values, in rank order, on every rank.
  template <class T>
  std::vector<T> all_gather(std::vector<T> const& values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<char> const bytes = all_gather_bytes(values.data(), values.size() * sizeof(T));
    std::vector<T> all(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::copy_n(bytes.data(), bytes.size(), reinterpret_cast<char*>(all.data()));
    return all;
  }

 private:
  void broadcast_bytes(void* data, std::size_t bytes, int root) const;
  std::vector<char> all_gather_bytes(void const* data, std::size_t bytes) const;

  MPI_Comm comm_;
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace layerloop
