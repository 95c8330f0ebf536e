#include "report/modes/colour_map.h"

#include <gtest/gtest.h>

#include "report/figures/palette.h"

namespace vibrissa::report {
namespace {

double luminance(const Colour& rgb) {
  return (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / 255.;
}

TEST(ColourMap, GetsBrighterAllTheWayForValuesOfOneSign) {
  const auto map = colour_map({0., 3.});
  for (std::size_t i = 8; i < map.size(); ++i)
    EXPECT_GT(luminance(map[i]), luminance(map[i - 8]) + 0.005) << i;
}

TEST(ColourMap, IsWhiteAtZeroForValuesOfBothSigns) {
  EXPECT_EQ(colour_range({-1., 4.}), (Range{-4., 4.}));
  const auto map = colour_map({-1., 4.});
  for (const int channel : map[map.size() / 2]) EXPECT_NEAR(channel, 247, 3);
  EXPECT_GT(map.front()[2], map.front()[0]) << "blue below zero";
  EXPECT_GT(map.back()[0], map.back()[2]) << "red above zero";
}

TEST(ColourMap, SpansSomethingForASingleValue) {
  EXPECT_GT(colour_range({2., 2.}).length(), 0.);
  EXPECT_GT(colour_range({0., 0.}).length(), 0.);
  EXPECT_GT(colour_range({-2., -2.}).length(), 0.);
}

TEST(Palette, HasDifferentColoursAndWrapsAround) {
  for (std::size_t i = 0; i < palette.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(palette_colour(i), palette_colour(j));
  EXPECT_EQ(palette_colour(palette.size() + 2), palette_colour(2));
}

TEST(Palette, TintMixesWithWhite) {
  EXPECT_EQ(tint({0, 100, 255}, 1.), (Colour{0, 100, 255}));
  EXPECT_EQ(tint({0, 100, 255}, 0.), (Colour{255, 255, 255}));
  EXPECT_EQ(tint({0, 155, 255}, 0.5), (Colour{128, 205, 255}));
}

}  // namespace
}  // namespace vibrissa::report
