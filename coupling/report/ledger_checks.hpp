#pragma once
#include <string>
#include <vector>

#include "coupling/run_record.hpp"

namespace layerloop::coupling {

struct LedgerEntry {
  std::string label, value_html;
  bool is_total = false;
};

/// One balance that must close.
struct LedgerCheck {
  std::string label, value_html;
  bool holds;
};

struct LedgerTable {
  std::string title;
  std::vector<LedgerEntry> entries;
  std::vector<LedgerCheck> checks;
};

/// Mass, particles, energy of the grains where it was booked and, with a laser, light and heat: what went in, where it
/// is, and whether it adds up.
std::vector<LedgerTable> ledgers(Ledger const& ledger, bool laser);

/// The checks of all tables.
std::vector<LedgerCheck> ledger_checks(Ledger const& ledger, bool laser);

}  // namespace layerloop::coupling
