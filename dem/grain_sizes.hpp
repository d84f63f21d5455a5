#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/case.hpp"

namespace layerloop::dem {

enum class Weight { number, volume };

/// Smallest diameter such that grains up to it hold at least this share of all, by number or volume; not a number
/// without grains. [m]
double diameter_quantile(std::vector<double> radii, double share, Weight weight);

/// Moment mean D[p, q] = sum d^p / sum d^q of the diameters (p - q = 1); not a number without grains. [m]
double mean_diameter(std::span<double const> radii, int p, int q);

/// The same quantile of the powder as the case describes it. [m]
double fed_diameter_quantile(PowderSettings const& powder, double share, Weight weight);

/// Lacey's mixing index of the coarse grains over slices: (s0^2 - s^2) / (s0^2 - sr^2) with the variance s^2 of their
/// share by number from slice to slice (weighted by grains), s0^2 = p (1 - p) for slices that are all coarse or all
/// fine, and sr^2 = p (1 - p) (slices - 1) / (grains - 1), what a random mixture of so many grains shows on average.
/// 1: mixed, 0: apart; not a number when all grains are alike. Lacey, J. Appl. Chem. 4 (1954) 257.
double lacey_index(std::span<std::size_t const> coarse, std::span<std::size_t const> all);

}  // namespace layerloop::dem
