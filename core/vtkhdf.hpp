#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/hdf5_file.hpp"
#include "core/powder_bed.hpp"
#include "core/triangle_surface.hpp"
#include "core/voxel_grid.hpp"

namespace layerloop {

// Groups of layerloop's own with units, and a /VTKHDF group (version 1.0: what ParaView 5.11 reads) in the same file.

/// One scalar per grain or per cell.
struct Field {
  std::string name;
  std::string unit;
  std::span<double const> values;
};

/// Adds group /bed (own layout, everything that PowderBed holds) to an open file.
void write_bed_group(Hdf5Writer& file, PowderBed const& bed);
PowderBed read_bed_group(Hdf5Reader const& file);

/// Adds group /substrate: vertices and triangles.
void write_surface_group(Hdf5Writer& file, TriangleSurface const& surface);
TriangleSurface read_surface_group(Hdf5Reader const& file);

/// bed_NNNN.h5: grains as VTK vertices with their radius, triangles of the substrate as VTK triangles; fields are per
/// grain (0 on triangle corners). UnstructuredGrid.
void write_bed_file(std::filesystem::path const& path, PowderBed const& bed, TriangleSurface const& substrate,
                    std::span<Field const> fields);

/// heat_NNNN.h5: ImageData with the fields as point data on cell centres, and group /grid.
void write_grid_file(std::filesystem::path const& path, VoxelGrid const& grid, std::span<Field const> fields);

}  // namespace layerloop
