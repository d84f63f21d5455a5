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
  std::optional<FileLock> alone;
  if (comm.is_root()) alone.emplace(folder.string() + ".lock", FileLock::Wait::until_free);
  comm.barrier();
  if (!comm.any(!fs::is_directory(folder))) return {folder, false};  // another process was at it
  fs::path const unfinished = folder.string() + ".unfinished";
  spread_layers(read, unfinished, comm, true);
  comm.barrier();
  if (comm.is_root()) fs::rename(unfinished, folder);
  comm.barrier();
  return {folder, true};
}

}  // namespace layerloop::coupling
