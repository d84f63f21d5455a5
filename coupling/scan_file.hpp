#pragma once
#include <filesystem>
#include <vector>

#include "core/heat_source.hpp"

namespace layerloop::coupling {

/// The way of a beam from a file: a header line `x [um],y [um],power [W],speed [mm/s]` or
/// `x [um],y [um],power [W],time [us]`, then one point a row. The beam starts at the first point; power and speed are
/// those on the way to the point of their row, the time is when it gets there. Power 0: the beam is off on that way.
/// \return the stretches with the beam on; coordinates as in the file [m], times from the first row
/// \throws InputError "file:line: ..."; FileError
std::vector<Track> read_scan_file(std::filesystem::path const& path);

}  // namespace layerloop::coupling
