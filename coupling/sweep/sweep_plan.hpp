#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/toml_entries.hpp"
#include "core/units.hpp"
#include "coupling/verb.hpp"

namespace layerloop::coupling {

/// grid: every value with every other. list: the first values together, the second, ... The others fill the ranges.
enum class SweepDesign { grid, list, latin_hypercube, sobol };

/// A value that a case gets for a key.
struct SweptValue {
  std::string text;     ///< for people
  double value;         ///< [SI]; not a number: a word
  std::string written;  ///< as TOML
};

struct SweptKey {
  std::string name;  ///< "laser.power"
  Dimension dimension = Dimension::none;
  bool is_number = false;
  std::vector<SweptValue> values = {};  ///< as written; of a space-filling design two: from, to
  Place place = {};                     ///< in the file
};

/// One run of the verb.
struct SweepCase {
  std::int64_t number = 0;              ///< from 1
  std::size_t point = 0;                ///< cases of one point differ in their seed only
  std::vector<SweptValue> values = {};  ///< by SweepPlan::keys
  Case checked;
};

/// Every case of a sweep, checked.
struct SweepPlan {
  std::string name;
  Verb verb = Verb::run;
  SweepDesign design = SweepDesign::grid;
  std::int64_t replicates = 1;
  std::vector<SweptKey> keys;
  std::size_t points = 0;
  std::vector<SweepCase> cases;                   ///< point by point, in each its seeds
  double hatch_spacing = 0, layer_thickness = 0;  ///< of the processing window [m]; 0: as the cases say
};

/// Reads a case file with a table [sweep] and checks every case. Keys of [sweep]: verb, design, cases (of a
/// space-filling design), replicates, seed (of the design), hatch_spacing and layer_thickness (that tracks on a plate
/// are judged for); of [sweep.vary]: keys of the case with a list of values. `overrides` as for read_case. \throws
/// InputError with every fault at its place; FileError
SweepPlan read_sweep(std::filesystem::path const& path, std::vector<std::string> const& overrides);

/// The plan with further points, each with all replicates; `points`: one value a key. \throws InputError
void append_points(SweepPlan& plan, std::vector<std::vector<SweptValue>> const& points,
                   std::filesystem::path const& path, std::vector<std::string> const& overrides);

/// A number of a key as a value, with every digit.
SweptValue swept_number(double value);

/// "laser.power = 200 W, scan.scan_speed = 0.8 m/s"
std::string words_of(SweepPlan const& plan, SweepCase const& one);

}  // namespace layerloop::coupling
