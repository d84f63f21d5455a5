#pragma once
#include <complex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace layerloop {

/// Complex refractive index n + ik of one measured set, at room temperature.
struct OpticalData {
  std::string name;    ///< substance and set, "Cu (Johnson 1972)": sets of one metal differ more than rays do
  std::string source;  ///< paper
  std::vector<double> wavelength;  ///< [m], ascending
  std::vector<std::complex<double>> index;

  bool covers(double at) const { return at >= wavelength.front() && at <= wavelength.back(); }
  /// Linear between the points. \throws InputError  outside the table, naming its range
  std::complex<double> operator()(double at) const;
};

std::vector<OpticalData> const& optical_data();

/// The set of this name. \throws InputError  unknown; names those that are
OpticalData const& optical_data(std::string_view name);
bool has_optical_data(std::string_view name);
std::vector<std::string> optical_data_names();

/// The set of the oxide that grows on the metal that a set such as "Al (Rakic 1995)" is of; empty where none is known.
std::string_view oxide_data_name(std::string_view data_name);

/// The conduction electrons of a metal. Source: Ordal et al., Appl. Opt. 24 (1985) 4493.
struct FreeElectrons {
  std::string_view metal;                        ///< "Cu"
  double plasma_wavenumber, damping_wavenumber;  ///< omega / (2 pi c) at room temperature [1/m]
};

/// Of the metal that a set such as "Cu (Johnson 1972)" is of; null where none are known.
FreeElectrons const* free_electrons(std::string_view data_name);

/// Index of a metal whose resistivity is `resistivity_ratio` times that at room temperature: the Drude term
/// -omega_p^2 / (omega^2 + i omega gamma) of its permittivity with gamma scaled by the ratio, the rest (interband
/// transitions) as measured: N^2 = N0^2 - D(gamma0) + D(gamma0 ratio). A ratio of 1 gives N0 to the bit.
/// Source: Ujihara, J. Appl. Phys. 43 (1972) 2376.
std::complex<double> heated_index(std::complex<double> cold_index, FreeElectrons const& electrons, double wavelength,
                                  double resistivity_ratio);

}  // namespace layerloop
