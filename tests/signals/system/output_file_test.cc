#include "signals/system/output_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <string>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

const auto write_new = [](std::ostream& out) { out << "new"; };

class WriteFile : public ::testing::Test {
 protected:
  // The old content is untouched and nothing else lies in the folder.
  void expect_untouched() const {
    EXPECT_EQ(content_of(file_), "old");
    EXPECT_EQ(folder_.n_entries(), 1u);
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.file("a.csv", "old");
};

using MakeNewFolder = WriteFile;
using FreeFolderName = WriteFile;

TEST_F(WriteFile, MakesANewFile) {
  write_file(folder_.path() / "b.csv", write_new);
  EXPECT_EQ(content_of(folder_.path() / "b.csv"), "new");
  EXPECT_EQ(folder_.n_entries(), 2u);
}

TEST_F(WriteFile, ReplacesAnOldFile) {
  write_file(file_, write_new);
  EXPECT_EQ(content_of(file_), "new");
  EXPECT_EQ(folder_.n_entries(), 1u);
}

TEST_F(WriteFile, WritesAllOfALongText) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += std::to_string(i) + "\n";
  write_file(file_, [&](std::ostream& out) {
    out << text.substr(0, 70000) << std::flush;
    for (const char c : text.substr(70000)) out.put(c);
  });
  EXPECT_EQ(content_of(file_), text);
}

TEST_F(WriteFile, LeavesTheOldContentUntilTheWriterIsDone) {
  write_file(file_, [&](std::ostream& out) {
    out << "new" << std::flush;
    EXPECT_EQ(content_of(file_), "old");
  });
}

TEST_F(WriteFile, CanWriteOneFileWhileItWritesAnother) {
  write_file(file_, [&](std::ostream& out) {
    out << "outer";
    write_file(folder_.path() / "b.csv", write_new);
  });
  EXPECT_EQ(content_of(file_), "outer");
  EXPECT_EQ(content_of(folder_.path() / "b.csv"), "new");
}

TEST_F(WriteFile, LeavesTheLeftoverOfAKilledRunAlone) {
  std::string unfinished;
  write_file(file_, [&](std::ostream&) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path()))
      if (entry.path() != file_) unfinished = entry.path().filename().string();
  });
  const std::size_t number_at = unfinished.rfind('-') + 1;
  const int next_number = std::stoi(unfinished.substr(number_at)) + 1;
  const fs::path leftover = folder_.file(
      unfinished.substr(0, number_at) + std::to_string(next_number), "of a run that was killed");
  write_file(file_, write_new);
  EXPECT_EQ(content_of(file_), "new");
  EXPECT_EQ(content_of(leftover), "of a run that was killed");
}

TEST_F(WriteFile, LeftoversOfProcessesThatHaveEndedCanBeRemoved) {
  const ::pid_t ended = ::fork();
  if (ended == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(ended, nullptr, 0), ended);
  fs::create_directory(folder_.path() / "deep");
  const fs::path dead =
      folder_.file("deep/.unfinished-" + std::to_string(ended) + "-3", "of a killed run");
  const fs::path alive =
      folder_.file(".unfinished-" + std::to_string(::getpid()) + "-77", "being written");
  const fs::path other = folder_.file(".unfinished-notes", "no number of a process");
  remove_unfinished_files(folder_.path());
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(alive));
  EXPECT_TRUE(fs::exists(other));
}

TEST_F(WriteFile, GivesUpWhenTheWriterThrows) {
  EXPECT_THAT(
      [&] {
        write_file(file_, [](std::ostream& out) {
          out << "half" << std::flush;
          throw std::logic_error("lost the plot");
        });
      },
      ThrowsMessage<std::logic_error>(HasSubstr("lost the plot")));
  expect_untouched();
}

TEST_F(WriteFile, GivesUpWhenTheWriterSetsTheStreamBad) {
  EXPECT_THAT(
      [&] {
        write_file(file_, [](std::ostream& out) {
          out << "half";
          out.setstate(std::ios::failbit);
        });
      },
      ThrowsMessage<InternalError>(
          AllOf(StartsWith(file_.string()), HasSubstr("the function that writes it failed"))));
  expect_untouched();
}

// A limit on the size of files makes the system refuse further bytes, as a full disk does.
TEST_F(WriteFile, GivesUpWhenTheDiskTakesNoMore) {
  ::rlimit old_limit;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  ::rlimit limit = old_limit;
  limit.rlim_cur = 100000;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    write_file(file_, [](std::ostream& out) { out << std::string(1000000, 'x'); });
  } catch (const ResourceError& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, AllOf(StartsWith(file_.string()), HasSubstr("File too large")));
  expect_untouched();
}

// A pipe of the test's own stands for all that is no regular file: a fault here must not be able to
// replace a device of the system.
TEST_F(WriteFile, WritesIntoAPipeWithoutReplacingIt) {
  const fs::path pipe = folder_.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_file(pipe, write_new);
  char received[16];
  const ::ssize_t n_received = ::read(reader, received, sizeof received);
  ::close(reader);
  EXPECT_EQ(std::string(received, static_cast<std::size_t>(std::max<::ssize_t>(n_received, 0))),
            "new");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(folder_.n_entries(), 2u);
}

TEST_F(WriteFile, SaysWhenTheFolderDoesNotExist) {
  const fs::path file = folder_.path() / "none" / "a.csv";
  EXPECT_THAT([&] { write_file(file, write_new); },
              ThrowsMessage<UserError>(
                  AllOf(StartsWith(file.string()), HasSubstr("No such file or directory"))));
  EXPECT_FALSE(fs::exists(folder_.path() / "none"));
}

TEST_F(WriteFile, SaysWhenTheFolderIsAFile) {
  EXPECT_THAT([&] { write_file(file_ / "b.csv", write_new); },
              ThrowsMessage<UserError>(HasSubstr("Not a directory")));
  expect_untouched();
}

TEST_F(WriteFile, SaysWhenTheNameIsAFolder) {
  for (const fs::path& name : {folder_.path(), folder_.path() / "", fs::path()})
    EXPECT_THAT([&] { write_file(name, write_new); },
                ThrowsMessage<UserError>(HasSubstr("this is a folder")));
  expect_untouched();
}

TEST_F(WriteFile, KeepsALinkAndReplacesWhatItPointsTo) {
  const fs::path link = folder_.path() / "link.csv";
  fs::create_symlink(file_, link);
  write_file(link, write_new);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content_of(file_), "new");
}

TEST_F(WriteFile, GivesTheUsualPermissionsToANewFileAndKeepsThoseOfAnOldOne) {
  const ::mode_t old_mask = ::umask(027);
  write_file(folder_.path() / "b.csv", write_new);
  ::umask(old_mask);
  EXPECT_EQ(fs::status(folder_.path() / "b.csv").permissions(), fs::perms{0640});
  fs::permissions(file_, fs::perms{0604});
  write_file(file_, write_new);
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms{0604});
}

TEST_F(WriteFile, WritesBesideANameWithoutAFolder) {
  const fs::path here = fs::current_path();
  fs::current_path(folder_.path());
  write_file("b.csv", write_new);
  fs::current_path(here);
  EXPECT_EQ(content_of(folder_.path() / "b.csv"), "new");
}

TEST_F(MakeNewFolder, MakesAFolderWithItsParentsOrTakesAnEmptyOne) {
  const fs::path run = folder_.path() / "runs" / "one";
  make_new_folder(run);
  EXPECT_TRUE(fs::is_directory(run));
  EXPECT_NO_THROW(make_new_folder(run));
}

// Both see it empty: the one that is later must not write into it, too.
TEST_F(MakeNewFolder, IsNotSharedWithAnotherProcess) {
  const fs::path run = folder_.path() / "run";
  std::array<int, 2> taken{}, finished{};
  ASSERT_EQ(::pipe(taken.data()) + ::pipe(finished.data()), 0);
  const ::pid_t child = ::fork();
  if (child == 0) {
    char byte = 0;
    make_new_folder(run);
    const bool is_told = ::write(taken[1], &byte, 1) == 1 && ::read(finished[0], &byte, 1) == 1;
    ::_exit(is_told ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(::read(taken[0], &byte, 1), 1);
  EXPECT_THAT([&] { make_new_folder(run); },
              ThrowsMessage<UserError>(HasSubstr("another run writes into it")));
  ASSERT_EQ(::write(finished[1], &byte, 1), 1);
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_NO_THROW(make_new_folder(run));
}

TEST_F(MakeNewFolder, RefusesAFolderThatHoldsSomething) {
  EXPECT_THAT([&] { make_new_folder(folder_.path()); },
              ThrowsMessage<UserError>(
                  AllOf(StartsWith(folder_.path().string()), HasSubstr("is not empty"))));
  expect_untouched();
}

TEST_F(MakeNewFolder, RefusesTheNameOfAFileOrAPlaceBelowOne) {
  EXPECT_THAT([&] { make_new_folder(file_); },
              ThrowsMessage<UserError>(HasSubstr("this is a file")));
  EXPECT_THAT([&] { make_new_folder(file_ / "run"); },
              ThrowsMessage<UserError>(HasSubstr("cannot be created: Not a directory")));
  EXPECT_THAT([] { make_new_folder(""); },
              ThrowsMessage<UserError>(HasSubstr("cannot be created")));
  expect_untouched();
}

TEST_F(FreeFolderName, IsTheFirstOfTheRowThatDoesNotExist) {
  const fs::path base = folder_.path() / "run";
  EXPECT_EQ(free_folder_name(base), base);
  fs::create_directory(base);
  EXPECT_EQ(free_folder_name(base), folder_.path() / "run-2");
  folder_.file("run-2", "a file is in the way, too");
  fs::create_directory(folder_.path() / "run-4");
  EXPECT_EQ(free_folder_name(base), folder_.path() / "run-3");
  EXPECT_EQ(free_folder_name(base / ""), folder_.path() / "run-3");
}

}  // namespace
}  // namespace vibrissa::signals
