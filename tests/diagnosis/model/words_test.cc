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

TEST(Wrapped, KeepsANumberAndItsUnitTogether) {
  const std::string start(96, 'x');
  EXPECT_THAT(wrapped(start + " 12 % of it").front(), start);
  EXPECT_THAT(wrapped(start + " 1 .. 2 m").front(), start);
  EXPECT_THAT(wrapped(start + " 1 -> 2 m", 1000, 2).back(), "  1 -> 2 m");
}

TEST(Wrapped, BreaksAWordThatIsLongerThanALine) {
  EXPECT_THAT(wrapped(std::string(250, 'x')), SizeIs(3));
}

TEST(Percent, HasNoTrailingZeros) {
  EXPECT_EQ(percent(0.123), "12 %");
  EXPECT_EQ(percent(0.0123), "1.2 %");
  EXPECT_EQ(percent(0.03), "3 %");
  EXPECT_EQ(percent(0.), "0 %");
  EXPECT_EQ(percent(1.), "100 %");
}

TEST(OneDecimal, HasNoTrailingZeros) {
  EXPECT_EQ(one_decimal(-12.34), "-12.3");
  EXPECT_EQ(one_decimal(5.), "5");
  EXPECT_EQ(one_decimal(-0.01), "0");
}

}  // namespace
}  // namespace vibrissa::diagnosis
