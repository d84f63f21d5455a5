#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "core/error.hpp"
#include "core/hdf5_file.hpp"
#include "core/vtkhdf.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

namespace fs = std::filesystem;

class Hdf5Test : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::temp_directory_path() / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::path path_ = folder_ / "file.h5";
};

PowderBed small_bed() {
  PowderBed bed;
  for (int i = 0; i < 7; ++i) bed.add(3 * i, Vec3(0.1 * i, 0.2, 1.0 / 3.0), 1e-5 / (i + 1), i % 3);
  bed.vx[2] = -std::numeric_limits<double>::denorm_min();
  bed.wz[6] = 1e300;
  bed.contacts = {{0, 3, {1e-9, -2e-9, 0}}, {3, -1, {0, 0, 5e-10}}};
  return bed;
}

TEST_F(Hdf5Test, numbers_of_every_type_come_back_bit_for_bit) {
  std::vector<double> const doubles{0.1, -0.0, std::numeric_limits<double>::denorm_min(), 1e308, INFINITY};
  std::vector<float> const floats{0.1f, std::numeric_limits<float>::min()};
  std::vector<std::int64_t> const longs{std::numeric_limits<std::int64_t>::min(), 7};
  std::vector<std::int32_t> const ints{-5, 6, 7, 8};
  std::vector<std::uint8_t> const bytes{0, 255, 3};
  {
    Hdf5Writer file(path_);
    file.write("deep/group/doubles", std::span<double const>(doubles), {5}, "m/s");
    file.write("floats", std::span<float const>(floats), {2});
    file.write("longs", std::span<std::int64_t const>(longs), {2});
    file.write("ints", std::span<std::int32_t const>(ints), {2, 2});
    file.write("bytes", std::span<std::uint8_t const>(bytes), {3});
    file.write("nothing", std::span<double const>(), {0, 3});
    file.attribute("/", "case", "Prüfung");
    file.attribute("/", "empty", "");
    file.commit();
  }
  Hdf5Reader const file(path_);
  EXPECT_EQ(file.read_doubles("deep/group/doubles"), doubles);
  EXPECT_TRUE(std::signbit(file.read_doubles("deep/group/doubles")[1]));
  EXPECT_EQ(file.read_floats("floats"), floats);
  EXPECT_EQ(file.read_int64("longs"), longs);
  EXPECT_EQ(file.read_int32("ints"), ints);
  EXPECT_EQ(file.read_bytes("bytes"), bytes);
  EXPECT_TRUE(file.read_doubles("nothing").empty());
  EXPECT_EQ(file.read_text_attribute("deep/group/doubles", "unit"), "m/s");
  EXPECT_EQ(file.read_text_attribute("/", "case"), "Prüfung");
  EXPECT_EQ(file.read_text_attribute("/", "empty"), "");
  EXPECT_TRUE(file.has("deep/group/doubles"));
  EXPECT_FALSE(file.has("deep/other/doubles"));
}

TEST_F(Hdf5Test, file_appears_only_at_commit) {
  {
    Hdf5Writer file(path_);
    std::vector<double> const one{1.0};
    file.write("one", std::span<double const>(one), {1});
    EXPECT_FALSE(fs::exists(path_));
  }
  EXPECT_TRUE(fs::is_empty(folder_)) << "an abandoned file must leave nothing behind";
}

TEST_F(Hdf5Test, wrong_use_and_wrong_contents_are_named) {
  std::vector<double> const values{1, 2, 3};
  {
    Hdf5Writer file(path_);
    EXPECT_THROW(file.write("bad_shape", std::span<double const>(values), {2}), FileError);
    file.write("values", std::span<double const>(values), {3});
    EXPECT_THROW(file.write("values", std::span<double const>(values), {3}), FileError);
    file.commit();
  }
  Hdf5Reader const file(path_);
  EXPECT_THROW(file.read_doubles("missing"), FileError);
  EXPECT_THROW(file.read_int32("values"), FileError);
  EXPECT_THROW(file.read_doubles("/"), FileError);
  EXPECT_THROW(file.read_text_attribute("values", "missing"), FileError);
  EXPECT_THROW(read_bed_group(file), FileError);
  EXPECT_THROW(Hdf5Writer(folder_ / "no" / "such" / "folder.h5"), FileError);
}

TEST_F(Hdf5Test, bed_and_surface_come_back_bit_for_bit) {
  PowderBed const bed = small_bed();
  TriangleSurface surface;
  surface.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 1.0 / 3.0)};
  surface.triangles = {{0, 1, 2}, {2, 1, 0}};
  std::vector<double> const mass(bed.size(), 1e-12);
  std::vector<Field> const fields{{"mass", "kg", mass}};
  write_bed_file(path_, bed, surface, fields);

  Hdf5Reader const file(path_);
  PowderBed const read = read_bed_group(file);
  EXPECT_EQ(read.id, bed.id);
  for (auto member : {&PowderBed::x, &PowderBed::y, &PowderBed::z, &PowderBed::radius, &PowderBed::vx, &PowderBed::vy,
                      &PowderBed::vz, &PowderBed::wx, &PowderBed::wy, &PowderBed::wz})
    EXPECT_EQ(read.*member, bed.*member);
  EXPECT_EQ(read.material, bed.material);
  ASSERT_EQ(read.contacts.size(), 2u);
  EXPECT_EQ(read.contacts[1].key_b, -1);
  EXPECT_EQ(read.contacts[1].spring, bed.contacts[1].spring);
  TriangleSurface const again = read_surface_group(file);
  EXPECT_EQ(again.vertices, surface.vertices);
  EXPECT_EQ(again.triangles, surface.triangles);
}

TEST_F(Hdf5Test, empty_bed_is_a_file_too) {
  write_bed_file(path_, PowderBed{}, TriangleSurface{}, {});
  EXPECT_EQ(read_bed_group(Hdf5Reader(path_)).size(), 0u);
}

TEST_F(Hdf5Test, damaged_groups_are_refused) {
  {
    Hdf5Writer file(path_);
    PowderBed bed = small_bed();
    bed.radius.pop_back();
    EXPECT_THROW(write_bed_group(file, bed), FileError);
  }
  {
    Hdf5Writer file(path_);
    PowderBed bed = small_bed();
    bed.id[3] = bed.id[2];  // ids must ascend
    write_bed_group(file, bed);
    TriangleSurface surface;
    surface.vertices = {Vec3(0, 0, 0)};
    surface.triangles = {{0, 0, 1}};  // corner 1 does not exist
    write_surface_group(file, surface);
    file.commit();
  }
  Hdf5Reader const file(path_);
  EXPECT_THROW(read_bed_group(file), FileError);
  EXPECT_THROW(read_surface_group(file), FileError);
}

TEST_F(Hdf5Test, field_of_wrong_length_is_refused) {
  std::vector<double> const two{1, 2};
  std::vector<Field> const fields{{"two", "", two}};
  EXPECT_THROW(write_bed_file(path_, small_bed(), {}, fields), FileError);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Hdf5Test, foreign_files_are_refused) {
  EXPECT_THROW(Hdf5Reader{path_}, FileError);  // missing
  write_file(path_, "");
  EXPECT_THROW(Hdf5Reader{path_}, FileError);
  write_file(path_, "x,y,z,radius\n1,2,3,4\n");
  EXPECT_THROW(Hdf5Reader{path_}, FileError);
  EXPECT_THROW(Hdf5Reader{folder_}, FileError);
}

TEST_F(Hdf5Test, every_truncation_is_refused) {
  write_bed_file(path_, small_bed(), {}, {});
  std::string const whole = read_file(path_);
  ASSERT_GT(whole.size(), 4096u);
  fs::path const cut = folder_ / "cut.h5";
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    std::ofstream(cut, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(length));
    EXPECT_THROW(read_bed_group(Hdf5Reader(cut)), FileError) << "cut to " << length << " bytes";
  }
}

}  // namespace
}  // namespace layerloop
