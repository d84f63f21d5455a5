#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "validation/explanation.hpp"

namespace layerloop::validation {

/// Mean square of the residuals of a stage's quantities, in units of their variance: 1 is noise alone.
struct StageMisfit {
  std::string stage;
  std::size_t observations = 0;
  double before = 0, after = 0;
};
std::vector<StageMisfit> stage_misfits(Explanation const& explained);

/// One step from the case as it stands to the noise.
struct WaterfallStep {
  std::string name;
  double chi2 = 0;
};
std::vector<WaterfallStep> waterfall(Diagnosis const& found);

/// Share of the excess of chi2 over its degrees of freedom that is gone. Not a number when there was no excess.
double share_explained(Diagnosis const& found, double chi2);

/// Model and measurement of every observation, in the units that people read.
std::string observations_csv(Study const& study, ObservationTable const& table);

/// The numbers of the report's pictures: observations.csv (parity and residuals), signatures.csv, stages.csv,
/// candidates.csv, cosines.csv, parameters.csv, waterfall.csv, patterns.csv, next.csv. \throws FileError
void write_explain_tables(std::filesystem::path const& folder, Explanation const& explained);

}  // namespace layerloop::validation
