#include "diagnosis/model/words.h"

#include <gmock/gmock.h>

namespace vibrissa::diagnosis {
namespace {

using testing::SizeIs;

std::string many_words() {
  std::string text = "first";
  for (int i = 0; i < 60; ++i) text += " word_" + std::to_string(i);
  return text;
}

TEST(Wrapped, KeepsEveryWordInLinesOfAHundred) {
  std::string back;
  for (const std::string& line : wrapped(many_words())) {
    EXPECT_LE(line.size(), 100u);
    back += line.starts_with("    ") ? line.substr(3) : line;
  }
  EXPECT_EQ(back, many_words());
}

TEST(Wrapped, EndsInDotsBehindAWholeWordWhereItMustNotGoOn) {
  const auto lines = wrapped(many_words(), 2);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_LE(lines[1].size(), 100u);
  EXPECT_THAT(lines[1], testing::ContainsRegex("word_[0-9]+ \\.\\.\\.$"));
}

TEST(Wrapped, BreaksAWordThatIsLongerThanALine) {
  EXPECT_THAT(wrapped(std::string(250, 'x')), SizeIs(3));
}

}  // namespace
}  // namespace vibrissa::diagnosis
