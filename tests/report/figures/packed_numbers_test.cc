#include "report/figures/packed_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <span>

#include "report/text/base64.h"
#include "tests/report/unpacked.h"

namespace vibrissa::report {
namespace {

using testing::unpacked;

std::string base64_of(const std::string& text) {
  return base64(std::as_bytes(std::span(text)));
}

TEST(Base64, IsThatOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

/// Alike to the last bit; any NaN is like any other.
void expect_same(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    if (std::isnan(expected[i]))
      EXPECT_TRUE(std::isnan(found[i])) << i;
    else
      EXPECT_EQ(std::memcmp(&found[i], &expected[i], sizeof(double)), 0) << i;
}

TEST(PackedNumbers, LosesNoDigit) {
  std::vector<double> clock, late_clock, uneven;
  for (int i = 0; i < 1000; ++i) {
    clock.push_back(i / 500.);
    late_clock.push_back(0.25 + i / 1000.);
    uneven.push_back(i == 500 ? 0.9999 : i / 500.);
  }
  for (const std::vector<double>& list :
       {clock, late_clock, uneven, std::vector<double>{}, std::vector<double>{1., 2.},
        std::vector<double>{-0., 1., 2.}, std::vector<double>{0.5, -0., INFINITY, NAN, 1e10f},
        std::vector<double>{1. / 3., NAN, -INFINITY, 5e-324, 1e308}}) {
    PackedNumbers numbers;
    numbers.add(list);
    expect_same(unpacked(numbers.json()[0]), list);
  }
}

TEST(PackedNumbers, TakesTheShortestFormAndKeepsEqualListsOnce) {
  PackedNumbers numbers;
  std::vector<double> clock;
  for (int i = 0; i < 1000; ++i) clock.push_back(i / 500.);
  EXPECT_EQ(numbers.add(clock), 0u);
  EXPECT_EQ(numbers.add({0.5, 0.25, 0.75}), 1u);
  EXPECT_EQ(numbers.add({0.1, 0.2, 0.7}), 2u);
  EXPECT_EQ(numbers.add(clock), 0u);
  ASSERT_EQ(numbers.json().size(), 3u);
  EXPECT_EQ(numbers.json()[0], nlohmann::json({{"n", 1000}, {"first", 0.}, {"rate", 500.}}));
  EXPECT_TRUE(numbers.json()[1].contains("f32"));
  EXPECT_TRUE(numbers.json()[2].contains("f64"));
}

}  // namespace
}  // namespace vibrissa::report
