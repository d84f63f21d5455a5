#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "coupling/melt_study.hpp"

namespace layerloop::coupling {

/// summary.json as the contract names it.
nlohmann::json melt_summary(MeltStudy const& study);

/// Highest peak above ambient on the sides and the bottom of the plate [K]: how far the far field is felt.
double edge_temperature_rise(MeltStudy const& study);

/// report.html, one page that needs no network.
std::string melt_page(std::filesystem::path const& folder, MeltStudy const& study);

/// Everything that the verb melt leaves in its folder. Only the root rank writes.
class MeltOutput {
 public:
  /// Makes the folder, writes case_resolved.toml. \throws FileError
  MeltOutput(Case const& placed, std::filesystem::path folder, Communicator const& comm);
  void write(MeltStudy& study) const;  ///< \throws FileError

 private:
  std::filesystem::path folder_;
  bool writes_;
};

}  // namespace layerloop::coupling
