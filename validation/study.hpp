#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace layerloop::validation {

// Measurements, the conditions under which they were made, and the numbers of the model that they may calibrate.
// Everything in SI; validation/study_file.hpp reads it.

/// One row of conditions.csv.
struct Condition {
  std::string id;
  std::map<std::string, double> inputs = {};       ///< case key -> value [SI]
  std::map<std::string, std::string> words = {};   ///< case key that takes a word -> word
  std::map<std::string, std::string> labels = {};  ///< machine, build, lot, plate -> which one
  std::map<std::string, double> u_inputs = {};     ///< case key -> one standard uncertainty of its value [SI]
};

enum class Role { train, holdout };

/// One row of measurements.csv.
struct Observation {
  std::string id;
  std::size_t condition = 0;   ///< index
  std::size_t observable = 0;  ///< index of what a model predicts for it
  std::string quantity;        ///< validation/quantity.hpp
  double value = 0;
  double u_stat = 0;     ///< one standard deviation of this reading
  double u_sys_rel = 0;  ///< share of the value, fully correlated over a sys_group
  double u_sys_abs = 0;  ///< the same as a value
  std::string sys_group = {}, rep_id = {};
  std::string oper = {}, instrument = {}, source = {}, exclude_reason = {};
  Role role = Role::train;
};

/// A reading that is a word (track.regime): for comparing only.
struct Category {
  std::string id;
  std::size_t observable = 0;  ///< index; a Prediction holds the place of the word in regime_words()
  std::string word;
};

/// What a model has to predict: replicates share one.
struct Observable {
  std::size_t condition = 0;
  std::string quantity;
  std::optional<int> layer = {};         ///< 1-based; none: the last
  std::optional<double> x = {}, y = {};  ///< where [m]; none: everywhere

  auto operator<=>(Observable const&) const = default;
};

/// One value that may be refitted: a [[calibration]] number, or that of one label, or the shared relative error of an
/// input that conditions.csv calls uncertain.
struct CalibrationParameter {
  std::string name;                ///< "laser.absorptivity", "laser.absorptivity of machine A", "error of laser.power"
  std::string key;                 ///< of the case
  double mean = 0, sd = 0;         ///< what is known of it beforehand; of an input's error: 0 and relative
  bool relative = false;           ///< factor 1 + value on the inputs of the conditions
  std::vector<bool> acts_on = {};  ///< by condition; empty: on all
};

struct Study {
  std::string name;
  std::filesystem::path folder, case_file;
  std::vector<Condition> conditions;      ///< in the order of acquisition
  std::vector<Observation> observations;  ///< in the order of acquisition; excluded ones are left out
  std::vector<Observable> observables;    ///< those of the observations first
  std::vector<CalibrationParameter> calibration;
  std::vector<std::string> limits = {};   ///< what these data cannot tell, in words
  std::vector<Category> categories = {};  ///< never in a covariance
};

}  // namespace layerloop::validation
