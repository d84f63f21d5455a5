#pragma once
#include <span>
#include <vector>

#include "thermal/conduction.hpp"
#include "thermal/heat_grid.hpp"

namespace layerloop::thermal {

/// Power into one own cell of a rank.
struct CellPower {
  std::int64_t cell;  ///< local
  double watts;
};

/// Which cells explicit steps may leave out. Metal that is no more than `rise` above ambient passes no heat on (it
/// takes heat up, and wakes when it has enough), so that cells among such cells cannot change: leaving them out costs
/// not a bit of the result. In every row one stretch is awake: from the first to the last warm or heated cell, and as
/// far around as heat can move before this is looked at again, one cell a step.
class AwakeRows {
 public:
  /// `rise` as a share of the enthalpy at the solidus: 3 K in steel, which moves its pool by 0.04 % at most.
  static constexpr double share_of_solidus = 2e-3;

  enum class Cold { asleep, awake };
  Cold cold = Cold::asleep;

  /// To be called before every step. \param floor  enthalpy up to which metal passes nothing on [J/m^3]
  /// \param source  ascending by cell \param passes  how often heat moves by a cell in the step \note Collective
  void update(Conduction const& conduction, HeatGrid const& grid, std::span<double const> enthalpy, double floor,
              std::span<CellPower const> source, int passes);
  /// The enthalpy has changed by other means than explicit steps.
  void forget() { passes_left_ = 0, known_ = false; }

  std::span<Row const> stepped() const { return stepped_; }      ///< parts of conduction.rows
  std::span<Row const> looked_up() const { return looked_up_; }  ///< parts of conduction.rows_with_neighbours

 private:
  static constexpr int passes_between_looks = 3;

  /// Cells [begin, end) of a row, in the grid's coordinates.
  struct Stretch {
    std::int32_t begin, end;
  };

  bool source_has_changed(HeatGrid const& grid, std::span<CellPower const> source);
  void find_warm(Conduction const& conduction, std::span<double const> enthalpy, double floor,
                 std::span<CellPower const> source);
  void widen(std::int32_t reach, bool periodic_y);
  void cut(LocalBox const& box, std::span<Row const> rows, std::vector<Row>& parts) const;

  std::array<std::int32_t, 3> n_{};  ///< of the grid
  std::vector<Stretch> warm_;        ///< of every row of the grid, y fastest
  std::vector<Stretch> scratch_;
  std::vector<Row> stepped_, looked_up_;
  std::vector<std::int64_t> heated_;  ///< cells of the last source
  double floor_ = 0;
  int passes_left_ = 0;
  bool known_ = false;  ///< cells that are not in `stepped_` are cold
};

}  // namespace layerloop::thermal
