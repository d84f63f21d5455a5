#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "validation/blind/world.hpp"

namespace layerloop::validation {

/// How a quantity is measured in a blind study of the stages. Uncertainties in SI.
struct StageInstrument {
  std::string quantity, group;
  double u_stat;     ///< of a reading
  double u_sys_rel;  ///< shared by the group
  double u_bed;      ///< scatter from one bed to the next, that the grains bring by themselves; 0: no bed
  bool once_a_bed;   ///< not again under every light
  int replicates;
};

/// A kind of blind study that the stages can run in seconds: its case, conditions and what may be hidden in it.
struct StageDesign {
  std::string name, case_text;
  std::vector<std::map<std::string, double>> conditions;  ///< case key -> value [SI]
  std::vector<std::string> bed_keys;                      ///< conditions that agree in them share their beds
  std::size_t held_out;                                   ///< the last of the conditions
  std::vector<StageInstrument> instruments;
  std::vector<CalibrationParameter> calibration;
  std::int64_t beds, measured_beds;  ///< of the model; of the truth
  std::map<std::string, double> true_resolution;
  std::vector<ScenarioClass> classes;
  std::vector<std::string> hidden_effects, biased_inputs;
  std::vector<ForeignCause> foreign_causes, jumps;
};

/// "powder": spread beds; "light": their absorptivity; "tracks": melt pools on a plate; "layer": melt pools on spread
/// powder, through the whole chain.
std::vector<StageDesign> const& stage_designs();

}  // namespace layerloop::validation
