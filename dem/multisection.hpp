#pragma once
#include <cstdint>
#include <vector>

#include "core/communicator.hpp"

namespace layerloop::dem {

/// Borders of slices along x with equal loads, found by recursive multisection: each border's interval is split into 64
/// parts, and again the one in which it lies, so that no rank ever sees all grains. \param x  of this rank's grains
/// \param load  of each \param low, high  borders of the first and of the last slice
/// \return slices + 1 borders, the same on every rank. Collective
std::vector<double> equal_loads(std::vector<double> const& x, std::vector<std::int64_t> const& load, std::size_t slices,
                                double low, double high, Communicator const& communicator);

}  // namespace layerloop::dem
