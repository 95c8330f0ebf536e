// Small files that claim much must not cost the memory that they claim.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <array>
#include <cstdint>
#include <string>

#include "signals/base/error.h"
#include "signals/formats/hdf5_file.h"
#include "signals/formats/mat_file.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.;
}

/// A variable of a version 4 file: five little numbers, its name, its values.
std::string version_4(std::uint32_t n_rows, std::uint32_t name_length,
                      const std::vector<double>& values) {
  const std::array<std::uint32_t, 5> head{0, n_rows, 1, 0, name_length};
  std::string out(reinterpret_cast<const char*>(head.data()), sizeof head);
  out += std::string("moment", 7);
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  return out;
}

TEST(Version4Mat, IsRead) {
  const test::TemporaryFolder folder;
  const auto file = folder.file("a.mat", version_4(3, 7, {1., 2., 4.}));
  const auto table = read_mat(file);
  ASSERT_EQ(table->columns().size(), 1u);
  EXPECT_EQ(table->columns().front(), "moment");
}

TEST(Version4Mat, ThatClaimsMoreThanItHoldsIsRefusedBeforeMemoryIsAskedFor) {
  const test::TemporaryFolder folder;
  const double before = peak_memory_mb();
  for (const std::string& bytes :
       {version_4(3, 0x68000000, {1., 2., 4.}), version_4(0x10000000, 7, {1.}),
        std::string("\2\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\x68\0\0\0", 23)}) {
    const auto file = folder.file("a.mat", bytes);
    EXPECT_THAT([&] { read_mat(file); },
                ThrowsMessage<UserError>(HasSubstr("cannot be read as a MATLAB file")));
  }
  EXPECT_LT(peak_memory_mb() - before, 100.);
}

/// One array of doubles; without values it claims to hold n and holds none.
struct Set {
  hsize_t n = 1;
  hsize_t n_chunk = 0;  // 0: in one piece
  hid_t type = H5T_NATIVE_DOUBLE;
  bool is_written = false;
};

void write_set(const std::filesystem::path& file, const Set& set) {
  const hid_t handle = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t most = H5S_UNLIMITED;
  const hid_t space = H5Screate_simple(1, &set.n, set.n_chunk > 0 ? &most : nullptr);
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  if (set.n_chunk > 0) H5Pset_chunk(list, 1, &set.n_chunk);
  const hid_t array = H5Dcreate2(handle, "moment", set.type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  if (set.is_written) {
    const std::vector<double> values(static_cast<std::size_t>(set.n), 1.);
    H5Dwrite(array, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  H5Dclose(array);
  H5Pclose(list);
  H5Sclose(space);
  H5Fclose(handle);
}

TEST(Hdf5, ThatClaimsMoreThanItHoldsIsRefusedBeforeMemoryIsAskedFor) {
  const test::TemporaryFolder folder;
  const double before = peak_memory_mb();
  for (const Set& set : {Set{.n = hsize_t{1} << 26, .n_chunk = hsize_t{1} << 16},
                         Set{.n = 1000, .n_chunk = hsize_t{1} << 28}}) {
    write_set(folder.path() / "a.h5", set);
    EXPECT_THAT([&] { read_hdf5(folder.path() / "a.h5"); },
                ThrowsMessage<UserError>(HasSubstr("'moment' declares")));
  }
  EXPECT_LT(peak_memory_mb() - before, 100.);
}

TEST(Hdf5, OfMonstrousNumbersIsRefusedBeforeMemoryIsAskedFor) {
  const test::TemporaryFolder folder;
  const double before = peak_memory_mb();
  const auto file = folder.path() / "a.h5";
  const hid_t type = H5Tcopy(H5T_IEEE_F64LE);
  H5Tset_size(type, std::size_t{1} << 29);
  write_set(file, {.type = type});
  H5Tclose(type);
  EXPECT_THAT([&] { read_hdf5(file); },
              ThrowsMessage<UserError>(HasSubstr("'moment' declares numbers of 536870912 bytes")));
  EXPECT_LT(peak_memory_mb() - before, 100.);
}

TEST(Hdf5, ThatIsShorterThanItsShapeIsRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.h5";
  const hsize_t n = 12345;
  write_set(file, {.n = n, .is_written = true});
  std::string bytes = test::content_of(file);
  // Its length in the layout, 8 n, becomes 8.
  const std::uint64_t length = 8 * n, damaged = 8;
  const std::string there(reinterpret_cast<const char*>(&length), sizeof length);
  const std::size_t at = bytes.find(there);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, sizeof damaged, reinterpret_cast<const char*>(&damaged), sizeof damaged);
  EXPECT_THAT(
      [&] { read_hdf5(folder.file("b.h5", bytes)); },
      ThrowsMessage<UserError>(HasSubstr("'moment' declares 12345 numbers, but has only 8 bytes")));
}

TEST(Hdf5, WhoseShapeIsSaidToLieInATableThatIsNotThereIsRefused) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.h5";
  write_set(file, {.n = 8, .is_written = true});
  std::string bytes = test::content_of(file);
  // A message of kind 1, the shape: kind, length and flags, then its body, which begins with a
  // version.
  const std::string shape("\x01\0\x18\0\0\0\0\0\x01\x01", 10);
  const std::string shared("\x01\0\x18\0\x02\0\0\0\x03\x01", 10);
  const std::size_t at = bytes.find(shape);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, shared.size(), shared);
  EXPECT_THAT([&] { read_hdf5(folder.file("b.h5", bytes)); },
              ThrowsMessage<UserError>(HasSubstr("b.h5: is damaged: the library")));
}

TEST(Hdf5, ThatHoldsWhatItClaimsIsRead) {
  const test::TemporaryFolder folder;
  write_set(folder.path() / "a.h5", {.n = 1000, .n_chunk = 512, .is_written = true});
  EXPECT_EQ(read_hdf5(folder.path() / "a.h5")->columns().size(), 1u);
}

}  // namespace
}  // namespace vibrissa::signals::formats
