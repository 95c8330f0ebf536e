// Small files that claim much must not cost the memory that they claim.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <array>
#include <cstdint>
#include <string>

#include "signals/error.h"
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
  const testing::TemporaryFolder folder;
  const auto file = folder.file("a.mat", version_4(3, 7, {1., 2., 4.}));
  const auto table = read_mat(file);
  ASSERT_EQ(table->columns().size(), 1u);
  EXPECT_EQ(table->columns().front(), "moment");
}

TEST(Version4Mat, ThatClaimsMoreThanItHoldsIsRefusedBeforeMemoryIsAskedFor) {
  const testing::TemporaryFolder folder;
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

/// A packed array of which no value was ever written, or of huge chunks of which one was.
void write_hollow(const std::filesystem::path& file, hsize_t n, hsize_t n_chunk, bool begun) {
  const hid_t handle = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t most = H5S_UNLIMITED;
  const hid_t space = H5Screate_simple(1, &n, &most), list = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(list, 1, &n_chunk);
  const hid_t set =
      H5Dcreate2(handle, "moment", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT);
  if (begun) {
    const std::vector<double> values(static_cast<std::size_t>(n), 1.);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  H5Dclose(set);
  H5Pclose(list);
  H5Sclose(space);
  H5Fclose(handle);
}

TEST(Hdf5, ThatClaimsMoreThanItHoldsIsRefusedBeforeMemoryIsAskedFor) {
  const testing::TemporaryFolder folder;
  const double before = peak_memory_mb();
  for (const hsize_t n_chunk : {hsize_t{1} << 16, hsize_t{1} << 28}) {
    const hsize_t n = n_chunk > hsize_t{1} << 20 ? 1000 : hsize_t{1} << 26;
    write_hollow(folder.path() / "a.h5", n, n_chunk, false);
    EXPECT_THAT([&] { read_hdf5(folder.path() / "a.h5"); },
                ThrowsMessage<UserError>(HasSubstr("'moment' claims")));
  }
  EXPECT_LT(peak_memory_mb() - before, 100.);
}

TEST(Hdf5, OfMonstrousNumbersIsRefusedBeforeMemoryIsAskedFor) {
  const testing::TemporaryFolder folder;
  const double before = peak_memory_mb();
  const auto file = folder.path() / "a.h5";
  const hid_t handle = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_IEEE_F64LE), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, std::size_t{1} << 29);
  H5Dclose(H5Dcreate2(handle, "moment", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
  H5Tclose(type);
  H5Fclose(handle);
  EXPECT_THAT([&] { read_hdf5(file); },
              ThrowsMessage<UserError>(HasSubstr("'moment' claims numbers of 536870912 bytes")));
  EXPECT_LT(peak_memory_mb() - before, 100.);
}

TEST(Hdf5, ThatIsShorterThanItsShapeIsRefused) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.h5";
  const hid_t handle = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t n = 12345;
  const hid_t space = H5Screate_simple(1, &n, nullptr);
  const hid_t set =
      H5Dcreate2(handle, "moment", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const std::vector<double> values(n, 1.);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Fclose(handle);
  std::string bytes = testing::content_of(file);
  // Its length in the layout, 8 n, becomes 8.
  const std::uint64_t length = 8 * n, damaged = 8;
  const std::string there(reinterpret_cast<const char*>(&length), sizeof length);
  const std::size_t at = bytes.find(there);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, sizeof damaged, reinterpret_cast<const char*>(&damaged), sizeof damaged);
  EXPECT_THAT([&] { read_hdf5(folder.file("b.h5", bytes)); },
              ThrowsMessage<UserError>(HasSubstr("'moment' claims 12345 numbers in 8 bytes")));
}

TEST(Hdf5, ThatHoldsWhatItClaimsIsRead) {
  const testing::TemporaryFolder folder;
  write_hollow(folder.path() / "a.h5", 1000, 512, true);
  EXPECT_EQ(read_hdf5(folder.path() / "a.h5")->columns().size(), 1u);
}

}  // namespace
}  // namespace vibrissa::signals::formats
