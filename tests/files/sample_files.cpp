// For tests that hold our files against other programs. `sample_files FOLDER` writes one bed and one grid file;
// `sample_files read FILE` reads a bed and ends with the code of what went wrong.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/vtkhdf.hpp"

namespace {

using namespace layerloop;

int read_bed(std::filesystem::path const& path) try {
  return read_bed_group(Hdf5Reader(path)).size() == 10 ? 0 : 1;
} catch (Error const& error) {
  std::puts(error.what());
  return static_cast<int>(error.code());
}

void write_samples(std::filesystem::path const& folder) {
  PowderBed bed;
  for (int i = 0; i < 10; ++i) bed.add(5 + i, Vec3(1e-5 * i, 2e-5 * i, 1.5e-5), 1e-6 * (i + 1), i % 2);
  bed.contacts.push_back({5, 6, {1e-9, 0, -1e-9}});
  TriangleSurface plate;
  plate.vertices = {Vec3(0, 0, 0), Vec3(1e-4, 0, 0), Vec3(0, 2e-4, 0), Vec3(1e-4, 2e-4, 0)};
  plate.triangles = {{0, 1, 2}, {1, 3, 2}};
  std::vector<double> layer(bed.size(), 2.0);
  std::vector<Field> const grain_fields{{"layer", "", layer}};
  write_bed_file(folder / "bed_0001.h5", bed, plate, grain_fields);

  VoxelGrid grid;
  grid.origin = Vec3(1e-4, 0, -2e-5);
  grid.cell = 5e-6;
  grid.n = {4, 3, 2};
  std::vector<double> temperature;
  for (std::int64_t cell = 0; cell < grid.size(); ++cell) temperature.push_back(300.0 + static_cast<double>(cell));
  std::vector<Field> const cell_fields{{"peak_temperature", "K", temperature}};
  write_grid_file(folder / "heat_0001.h5", grid, cell_fields);
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 3 && std::string(arguments[1]) == "read") return read_bed(arguments[2]);
  write_samples(arguments[1]);
}
