#include "core/communicator.hpp"

#include <algorithm>
#include <numeric>

namespace layerloop {
namespace {
constexpr std::size_t chunk_bytes = std::size_t{1} << 30;  // MPI counts are int
}

Communicator::Communicator(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &size_);
}

void Communicator::barrier() const { MPI_Barrier(comm_); }

double Communicator::max(double value) const {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm_);
  return value;
}

double Communicator::min(double value) const {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MIN, comm_);
  return value;
}

std::int64_t Communicator::sum(std::int64_t value) const {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, comm_);
  return value;
}

bool Communicator::any(bool value) const { return sum(std::int64_t{value}) > 0; }

double Communicator::sum(double value) const {
  std::vector<double> const all = all_gather(std::vector<double>{value});
  return std::accumulate(all.begin(), all.end(), 0.0);
}

void Communicator::broadcast(std::string& text, int root) const {
  std::vector<char> bytes(text.begin(), text.end());
  broadcast(bytes, root);
  text.assign(bytes.begin(), bytes.end());
}

void Communicator::broadcast_bytes(void* data, std::size_t bytes, int root) const {
  char* at = static_cast<char*>(data);
  for (std::size_t sent = 0; sent < bytes; sent += chunk_bytes) {
    MPI_Bcast(at + sent, static_cast<int>(std::min(chunk_bytes, bytes - sent)), MPI_BYTE, root, comm_);
  }
}

std::vector<char> Communicator::all_gather_bytes(void const* data, std::size_t bytes) const {
  std::vector<std::uint64_t> sizes(static_cast<std::size_t>(size_));
  std::uint64_t const own = bytes;
  MPI_Allgather(&own, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, comm_);
  std::vector<char> all(std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0}));
  std::size_t offset = 0;
  for (int root = 0; root < size_; ++root) {
    std::size_t const count = sizes[static_cast<std::size_t>(root)];
    if (root == rank_ && count > 0) std::copy_n(static_cast<char const*>(data), count, all.data() + offset);
    broadcast_bytes(all.data() + offset, count, root);
    offset += count;
  }
  return all;
}

}  // namespace layerloop
