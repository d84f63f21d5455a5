#include "coupling/bed_cache.hpp"

#include <optional>

#include "core/error.hpp"
#include "coupling/case_content.hpp"
#include "coupling/file_lock.hpp"
#include "coupling/melt_bed.hpp"

namespace layerloop::coupling {

namespace fs = std::filesystem;

BedCache::Bed BedCache::spread(Case const& checked, Communicator const& comm) const {
  Case const read = what_spreading_reads(checked);
  fs::path const folder = folder_ / hash_of(content_of(read));
  if (!comm.any(!fs::is_directory(folder))) return {folder, false};
  fs::path const unfinished = folder.string() + ".unfinished", lock = folder.string() + ".lock";
  std::optional<FileLock> alone;
  if (comm.is_root()) alone.emplace(lock, FileLock::Wait::until_free);
  if (comm.any(alone && !alone->held()))
    throw StoppedBySignal("stopped by a signal while another process spreads the bed (as asked) go on with --resume");
  if (!comm.any(!fs::is_directory(folder))) return {folder, false};  // another process was at it
  spread_layers(read, unfinished, comm, true);
  comm.barrier();
  if (comm.is_root()) {
    fs::rename(unfinished, folder);
    fs::remove(lock);  // whoever waits for it sees the bed then
  }
  comm.barrier();
  return {folder, true};
}

}  // namespace layerloop::coupling
