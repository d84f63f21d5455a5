#include "core/optical_constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "core/error.hpp"
#include "core/optical_tables.hpp"
#include "core/spelling.hpp"

namespace layerloop {
namespace {

std::vector<OpticalData> read_tables() {
  constexpr double micrometre = 1e-6;
  std::vector<OpticalData> sets;
  std::istringstream text{std::string(optical_tables)};
  for (std::string line; std::getline(text, line);) {
    if (line.empty()) continue;
    if (std::size_t const bar = line.find(" | "); bar != line.npos) {
      sets.push_back({line.substr(0, bar), line.substr(bar + 3), {}, {}});
      continue;
    }
    std::istringstream points(line);
    double wavelength, n, k;
    for (char comma; points >> wavelength >> n >> k; points >> comma) {
      sets.back().wavelength.push_back(wavelength * micrometre);
      sets.back().index.emplace_back(n, k);
    }
  }
  return sets;
}

OpticalData const* find(std::string_view name) {
  auto const& sets = optical_data();
  auto const found = std::ranges::find(sets, name, &OpticalData::name);
  return found == sets.end() ? nullptr : &*found;
}

}  // namespace

std::complex<double> OpticalData::operator()(double at) const {
  if (!covers(at)) {
    throw InputError(
        fmt::format("the refractive index of {} is known from {:.3g} to {:.3g} um only (not at {:.4g} um) "
                    "give optics.refractive_index",
                    name, wavelength.front() * 1e6, wavelength.back() * 1e6, at * 1e6));
  }
  auto const above = std::upper_bound(wavelength.begin() + 1, wavelength.end() - 1, at);
  auto const i = static_cast<std::size_t>(above - wavelength.begin());
  double const share = (at - wavelength[i - 1]) / (wavelength[i] - wavelength[i - 1]);
  return index[i - 1] + share * (index[i] - index[i - 1]);
}

std::vector<OpticalData> const& optical_data() {
  static std::vector<OpticalData> const sets = read_tables();
  return sets;
}

OpticalData const& optical_data(std::string_view name) {
  if (OpticalData const* set = find(name)) return *set;
  std::vector<std::string> const names = optical_data_names();
  throw InputError(fmt::format("no optical constants are called \"{}\" (known: {}){}", name, fmt::join(names, ", "),
                               did_you_mean(std::string(name), names)));
}

bool has_optical_data(std::string_view name) { return find(name) != nullptr; }

std::vector<std::string> optical_data_names() {
  std::vector<std::string> names;
  for (OpticalData const& set : optical_data()) names.push_back(set.name);
  return names;
}

std::string_view oxide_data_name(std::string_view data_name) {
  std::string_view const metal = data_name.substr(0, data_name.find(' '));
  if (metal == "Al") return "Al2O3 (Malitson 1972)";
  if (metal == "Ti") return "TiO2 (Devore 1951)";
  if (metal == "Fe") return "Fe2O3 (Querry 1985)";
  return "";
}

FreeElectrons const* free_electrons(std::string_view data_name) {
  constexpr double per_cm = 100;
  static constexpr std::array<FreeElectrons, 9> metals{{{"Al", 119000 * per_cm, 660 * per_cm},
                                                        {"Cu", 59600 * per_cm, 73.2 * per_cm},
                                                        {"Au", 72800 * per_cm, 215 * per_cm},
                                                        {"Ag", 72700 * per_cm, 145 * per_cm},
                                                        {"Fe", 33000 * per_cm, 147 * per_cm},
                                                        {"Mo", 60200 * per_cm, 412 * per_cm},
                                                        {"Ni", 39400 * per_cm, 352 * per_cm},
                                                        {"Ti", 20300 * per_cm, 382 * per_cm},
                                                        {"W", 51700 * per_cm, 487 * per_cm}}};
  auto const found = std::ranges::find(metals, data_name.substr(0, data_name.find(' ')), &FreeElectrons::metal);
  return found == metals.end() ? nullptr : &*found;
}

std::complex<double> heated_index(std::complex<double> cold_index, FreeElectrons const& electrons, double wavelength,
                                  double resistivity_ratio) {
  if (resistivity_ratio == 1) return cold_index;
  double const omega = 1 / wavelength;  // everything in wavenumbers
  auto const drude = [&](double damping) {
    return -electrons.plasma_wavenumber * electrons.plasma_wavenumber / (omega * std::complex<double>(omega, damping));
  };
  return std::sqrt(cold_index * cold_index - drude(electrons.damping_wavenumber) +
                   drude(electrons.damping_wavenumber * resistivity_ratio));
}

}  // namespace layerloop
