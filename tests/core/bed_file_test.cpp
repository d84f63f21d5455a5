#include "core/bed_file.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/vtkhdf.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

namespace fs = std::filesystem;

fs::path file_with(std::string const& name, std::string const& text) {
  fs::path const path = fs::path(testing::TempDir()) / name;
  write_file(path, text);
  return path;
}

/// Grains at places that need every digit, with velocities, not in order of x.
BedFile sample() {
  BedFile file{.bed = {}, .periodic_x = std::nullopt, .periodic_y = 175e-6, .floor_z = -1e-4 / 3, .density = 9187};
  for (std::int64_t k = 0; k < 50; ++k) {
    auto const u = uniform4(5, RandomStream::grain_position, static_cast<std::uint64_t>(k));
    file.bed.add(7 + 3 * k, Vec3(1e-3 * u[0], 175e-6 * u[1], 1e-4 * u[2] - 5e-5), 6.5e-6 + 1e-5 * u[3], k % 2);
    auto const v = uniform4(6, RandomStream::grain_position, static_cast<std::uint64_t>(k));
    file.bed.vx.back() = v[0] - 0.5, file.bed.vz.back() = v[1] / 3, file.bed.wy.back() = -1e4 * v[2];
  }
  return file;
}

std::string refusal(fs::path const& path, std::optional<std::int64_t> frame = std::nullopt) {
  try {
    read_bed(path, frame);
  } catch (InputError const& fault) {
    return fault.what();
  }
  return "accepted";
}

void expect_refused(std::string const& text, std::string const& line, std::string const& words) {
  fs::path const path = file_with("refused", text);
  std::string const told = refusal(path);
  EXPECT_TRUE(told.starts_with(path.string() + ":" + line + ": ")) << told << "\nexpected in line " << line;
  EXPECT_NE(told.find(words), std::string::npos) << told << "\nexpected " << words;
}

class RoundTrip : public testing::TestWithParam<BedFormat> {};

TEST_P(RoundTrip, KeepsEveryBit) {
  BedFile const file = sample();
  fs::path const path = fs::path(testing::TempDir()) / ("bed." + std::string(extension(GetParam())));
  write_bed(path, file, GetParam());
  BedFile const back = read_bed(path);
  EXPECT_EQ(back.bed.x, file.bed.x);
  EXPECT_EQ(back.bed.y, file.bed.y);
  EXPECT_EQ(back.bed.z, file.bed.z);
  EXPECT_EQ(back.bed.radius, file.bed.radius);
  EXPECT_EQ(back.bed.material, file.bed.material);
  if (GetParam() != BedFormat::csv) {
    EXPECT_EQ(back.bed.id, file.bed.id);
    EXPECT_EQ(back.bed.vx, file.bed.vx);
    EXPECT_EQ(back.bed.wy, file.bed.wy);
  }
  if (GetParam() != BedFormat::h5) {
    EXPECT_EQ(back.periodic_y, file.periodic_y);
    EXPECT_EQ(back.periodic_x, std::nullopt);
  }
  if (GetParam() == BedFormat::csv || GetParam() == BedFormat::extxyz) {
    EXPECT_EQ(back.density, file.density);
    EXPECT_EQ(back.floor_z, file.floor_z);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip,
                         testing::Values(BedFormat::csv, BedFormat::dump, BedFormat::extxyz, BedFormat::h5),
                         [](auto const& info) { return std::string(extension(info.param)); });

TEST(BedCsv, AsTheContractWritesIt) {
  BedFile const file = read_bed(file_with("contract.csv",
                                          "# periodic_x=4.5e-4 periodic_y=4.5e-4 floor_z=0 units=m density=9187\n"
                                          "# x,y,z,radius\n1e-4,2e-4,3e-5,1.4e-5\n\n4e-4,1e-4,2e-5,6.5e-6\r\n"));
  ASSERT_EQ(file.bed.size(), 2U);
  EXPECT_EQ(file.bed.x[1], 4e-4);
  EXPECT_EQ(file.bed.radius[1], 6.5e-6);
  EXPECT_EQ(file.bed.id[1], 1);
  EXPECT_EQ(file.periodic_x, 4.5e-4);
  EXPECT_EQ(file.floor_z, 0);
  EXPECT_EQ(file.density, 9187);
}

TEST(BedCsv, UnitsAndOrderOfColumnsAreTheFilesOwn) {
  BedFile const file =
      read_bed(file_with("own.csv", "# units=um periodic_y=450\nradius,material,z,y,x\n14,1,30,200,100\n"));
  EXPECT_DOUBLE_EQ(file.bed.x[0], 1e-4);
  EXPECT_DOUBLE_EQ(file.bed.radius[0], 1.4e-5);
  EXPECT_EQ(file.bed.material[0], 1);
  EXPECT_DOUBLE_EQ(*file.periodic_y, 4.5e-4);
  EXPECT_FALSE(file.periodic_x);
}

TEST(BedCsv, TellsWhereItIsWrong) {
  expect_refused("# units=m\n# x,y,z,radius\n1e-4,2e-4,3e-5\n", "3", "3 values in a row");
  expect_refused("# units=m\n1e-4,2e-4,3e-5,oops\n", "2", "\"oops\" is not a number");
  expect_refused("# units=m\n1e-4,nan,3e-5,1e-5\n", "2", "not a number");
  expect_refused("# units=furlong\n1,2,3,4\n", "1", "units=furlong");
  expect_refused("# units=m\n100,200,30,14\n", "2", "metres");
  expect_refused("# x,y,z,size\n1e-4,2e-4,3e-5,1e-5\n", "1", "\"size\" is not known");
  expect_refused("# x,y,z,material\n1e-4,2e-4,3e-5,1\n", "1", "\"radius\" is missing");
  expect_refused("# units=m\n", "1", "no grains");
}

std::string const header = "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff pp ff\n0 1e-3\n";
std::string const columns = "1e-5 1.9e-4\n-1e-4 1e-3\nITEM: ATOMS id type radius x y z vx vy vz \n";

TEST(BedDump, ColumnsAreFoundByName) {
  std::string const rows = "9 2 1e-5 5e-4 2e-5 3e-5 0.1 0 -0.2\n4 1 6.5e-6 1e-4 1e-4 1e-5 0 0 0\n";
  BedFile const file = read_bed(file_with("a.dump", header + columns + rows));
  EXPECT_EQ(file.bed.id, (std::vector<std::int64_t>{4, 9}));
  EXPECT_EQ(file.bed.radius, (std::vector<double>{6.5e-6, 1e-5}));
  EXPECT_EQ(file.bed.material, (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(file.bed.vz[1], -0.2);
  EXPECT_DOUBLE_EQ(*file.periodic_y, 1.8e-4);
  EXPECT_FALSE(file.periodic_x);
  EXPECT_DOUBLE_EQ(file.bed.y[1], 1e-5);  // counted from the lower bound of the period
}

TEST(BedDump, LastFrameUnlessAnotherIsChosen) {
  std::string text;
  for (int k = 1; k < 4; ++k)
    text += "ITEM: TIMESTEP\n" + std::to_string(k) +
            "\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS x y z diameter\n" +
            std::to_string(k) + "e-4 0 0 2e-5\n";
  fs::path const path = file_with("frames.dump", text);
  EXPECT_EQ(read_bed(path).bed.x[0], 3e-4);
  EXPECT_EQ(read_bed(path, 0).bed.x[0], 1e-4);
  EXPECT_EQ(read_bed(path, 1).bed.radius[0], 1e-5);
  EXPECT_NE(refusal(path, 3).find("frame 3 of a dump with 3"), std::string::npos);
}

TEST(BedDump, TellsWhereItIsWrong) {
  expect_refused(header + columns + "9 2 1e-5 5e-4 2e-5 3e-5 0.1 0 -0.2\n", "10", "cut short");
  expect_refused(header + columns + "9 2 1e-5 5e-4 2e-5\n", "10", "5 values in a row");
  expect_refused(header + columns + "9 2 1e-5 0 0 0 0 0 0\n9 2 1e-5 1e-4 0 0 0 0 0\n", "11", "there twice");
  expect_refused(header + "0 1\n0 1\nITEM: ATOMS id x y z\n1 0 0 0\n2 0 0 0\n", "9", "no column radius");
  expect_refused(header + "0 1\n0 1\nITEM: ATOMS id xs ys zs radius\n", "9", "no column x");
  expect_refused("ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\nmany\n", "4", "not a whole number");
}

TEST(BedExtxyz, TellsWhereItIsWrong) {
  expect_refused("1\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=species:S:1:pos:R:3\nNi 0 0 0\n", "2", "no radius");
  expect_refused("1\nproperties\nNi 0 0 0 1e-5\n", "2", "no Properties");
  expect_refused("2\nProperties=species:S:1:pos:R:3:radius:R:1\nNi 0 0 0 1e-5\n", "3", "cut short");
  expect_refused("1\nLattice=\"1 0.1 0 0 1 0 0 0 1\" Properties=pos:R:3:radius:R:1\n0 0 0 1e-5\n", "2", "tilted");
}

TEST(BedFile, MissingFileIsFileTrouble) { EXPECT_THROW(read_bed("/nowhere/bed.csv"), FileError); }

/// Cut anywhere, or with any byte replaced, a good file is read or refused, never worse.
TEST(BedFile, DamagedFilesAreReadOrRefused) {
  BedFile small = sample();
  std::vector<char> keep(small.bed.size(), 0);
  keep[0] = keep[1] = 1;
  small.bed.retain(keep);
  for (BedFormat const format : {BedFormat::csv, BedFormat::dump, BedFormat::extxyz}) {
    fs::path const path = fs::path(testing::TempDir()) / "damaged";
    write_bed(path, small, format);
    std::string const good = read_file(path);
    for (std::size_t at = 0; at < good.size(); at += 11) {
      std::ofstream(path, std::ios::binary) << good.substr(0, at);
      refusal(path);
      for (char const byte : {'\n', '-', '\0', ':'}) {
        std::string damaged = good;
        damaged[at] = byte;
        std::ofstream(path, std::ios::binary) << damaged;
        refusal(path);
      }
    }
  }
}

/// A dump of LIGGGHTS itself: two grains under gravity for a few steps.
TEST(BedDump, OfLiggghtsIsRead) {
  if (!fs::exists("/usr/bin/liggghts")) GTEST_SKIP() << "liggghts is not installed (apt-get install liggghts)";
  fs::path const folder = fs::path(testing::TempDir()) / "liggghts_dump";
  fs::create_directories(folder);
  write_file(folder / "in.two", R"(units si
atom_style granular
boundary f p f
newton off
communicate single vel yes
region box block 0 1e-3 -1e-4 1e-4 -1e-4 1e-3 units box
create_box 1 box
neighbor 4e-6 bin
fix m1 all property/global youngsModulus peratomtype 2e8
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.7
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 3e-8
create_atoms 1 single 2e-4 5e-5 1e-4 units box
create_atoms 1 single 4e-4 -5e-5 2e-4 units box
set atom 1 diameter 2.6e-5 density 8190
set atom 2 diameter 4.2e-5 density 8190
fix integr all nve/sphere
fix grav all gravity 9.81 vector 0 0 -1
dump d1 all custom 50 two.dump id type x y z radius vx vy vz omegax omegay omegaz
dump_modify d1 format "%d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run 100
)");
  std::string const command = "cd '" + folder.string() +
                              "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 /usr/bin/liggghts -in "
                              "in.two > out.txt 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(folder / "out.txt");
  BedFile const file = read_bed(folder / "two.dump");
  ASSERT_EQ(file.bed.size(), 2U);
  EXPECT_NEAR(file.bed.radius[0], 1.3e-5, 1e-19);
  EXPECT_NEAR(file.bed.radius[1], 2.1e-5, 1e-19);
  EXPECT_NEAR(*file.periodic_y, 2e-4, 1e-18);
  EXPECT_NEAR(file.bed.y[0], 1.5e-4, 1e-15);
  double const t = 100 * 3e-8;
  EXPECT_NEAR(file.bed.vz[0], -9.81 * t, 1e-12);
  EXPECT_NEAR(file.bed.z[0], 1e-4 - 0.5 * 9.81 * t * t, 1e-14);
  EXPECT_EQ(read_bed(folder / "two.dump", 0).bed.z[1], 2e-4);
}

}  // namespace
}  // namespace layerloop
