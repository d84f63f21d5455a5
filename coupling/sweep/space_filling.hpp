#pragma once
#include <cstdint>
#include <vector>

namespace layerloop::coupling {

/// Points in the unit cube, (points, dimensions).
using UnitPoints = std::vector<std::vector<double>>;

/// Latin hypercube: in every dimension each of `points` equal slices holds one point (McKay, Beckman & Conover,
/// Technometrics 21:239, 1979). Of 200 draws the one whose nearest two points lie farthest apart (Morris & Mitchell,
/// J. Stat. Plan. Inference 43:381, 1995).
UnitPoints latin_hypercube(std::int64_t points, std::size_t dimensions, std::uint64_t seed);

/// Sobol's sequence from its start, shifted by random digits so that no point lies on the edge: every elementary
/// interval of the net keeps its points. More points continue the same sequence.
UnitPoints sobol_points(std::int64_t points, std::size_t dimensions, std::uint64_t seed);

}  // namespace layerloop::coupling
