#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/powder_bed.hpp"

namespace layerloop {

/// Grains and the box they lie in, as programs exchange them. SI.
struct BedFile {
  PowderBed bed;                                 ///< ascending by id; at rest where the file gives no velocities
  std::optional<double> periodic_x, periodic_y;  ///< periods [m]; open without
  std::optional<double> floor_z;                 ///< [m]
  std::optional<double> density;                 ///< of the grains' metal [kg/m^3]
};

/// csv: "# periodic_x=... units=m ...", "# x,y,z,radius[,material]", rows. dump: LIGGGHTS and LAMMPS text dumps with
/// the columns x y z and radius or diameter; id, type (material + 1), velocities and spins where there. extxyz:
/// Lattice, pbc and Properties with pos and radius. h5: what layerloop writes.
enum class BedFormat { csv, dump, extxyz, h5 };
std::string_view extension(BedFormat format);  ///< "csv"

/// Reads a bed; the format follows from the first lines of the file. \param frame  of several: counted from 0; by
/// default the last
/// \throws InputError damaged, as "file:line: problem (why) suggestion"; FileError cannot be opened
BedFile read_bed(std::filesystem::path const& path, std::optional<std::int64_t> frame = std::nullopt);

/// Writes csv, dump or extxyz with 17 significant digits: reading gives the same bits. csv holds positions, radii and
/// materials; the others velocities and spins too. Contact springs are in h5 only, which write_bed_file
/// (core/vtkhdf.hpp) writes. \throws FileError
void write_bed(std::filesystem::path const& path, BedFile const& file, BedFormat format);

}  // namespace layerloop
