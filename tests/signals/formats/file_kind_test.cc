#include "signals/formats/file_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "signals/base/error.h"
#include "signals/files/file_format.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

void expect_named(const std::string& name, const std::string& bytes, const std::string& kind) {
  const test::TemporaryFolder folder;
  const auto file = folder.file(name, bytes);
  EXPECT_THAT([&] { open_table(file); },
              ThrowsMessage<UserError>(AllOf(HasSubstr(name + ": this is "), HasSubstr(kind))));
}

TEST(FileKind, NamesWhatAFileIs) {
  expect_named("r.csv", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "Git LFS");
  expect_named("r.mat", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "Git LFS");
  expect_named("r.csv", std::string("PK\x03\x04\0\0", 6), "zip archive");
  expect_named("r.xlsx", std::string("PK\x03\x04\0\0", 6), "spreadsheet");
  expect_named("r.npz", std::string("PK\x03\x04\0\0", 6), "archive of NumPy arrays");
  expect_named("r.csv.gz", "\x1f\x8b\x08", "gzip");
  expect_named("r.tdms", "TDSm\x0e", "TDMS");
  expect_named("r.dat", "RIFF\1\1\1\1WAVE", "sound file");
  expect_named("r.txt", "\x93NUMPY\1", "NumPy array");
  expect_named("r.msd", "000001D AAAAA  BHZXX" + std::string(60, '\0'), "miniSEED");
}

TEST(FileKind, LeavesAFileOfItsOwnKindAlone) {
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(refuse_other_kinds(folder.file("r.npy", "\x93NUMPY\1"), ".npy"));
  EXPECT_NO_THROW(refuse_other_kinds(folder.file("r.mat", "\x89HDF\r\n\x1a\n"), ".mat"));
  EXPECT_NO_THROW(refuse_other_kinds(folder.file("r.csv", "t,ax\n0,1\n"), ".csv"));
}

}  // namespace
}  // namespace vibrissa::signals::formats
