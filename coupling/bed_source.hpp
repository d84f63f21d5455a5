#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/bed_file.hpp"
#include "core/case.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::coupling {

/// A file of grains and what it may lack. Lengths in m.
struct BedSource {
  std::filesystem::path bed;                              ///< csv, dump, extxyz or h5
  std::filesystem::path mesh;                             ///< STL, or empty
  std::optional<double> periodic_x, periodic_y, floor_z;  ///< replace those of the file
};

/// The grains of such a file, brought into its tile, of materials that the case knows; periods always set, 0: open.
/// \throws InputError the file is damaged, or a material is not of the case; FileError
BedFile read_source(BedSource const& source, Case const& checked);

/// Makes all grains the case's only material, or, with a mixture, checks that theirs are of the case.
/// \param path  that the bed comes from \throws InputError
void check_materials(PowderBed& bed, Case const& checked, std::string const& path);

/// Brings coordinates into [0, period); nothing with a period of 0.
void wrap(std::vector<double>& coordinate, double period);

}  // namespace layerloop::coupling
