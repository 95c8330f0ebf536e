#include "report/figures/colour_map.h"

#include <gtest/gtest.h>

#include "report/figures/palette.h"

namespace vibrissa::report {
namespace {

double luminance(const double* rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

TEST(ColourMap, GetsBrighterAllTheWayForValuesOfOneSign) {
  const auto map = colour_map({0., 3.});
  EXPECT_EQ(map->GetTableRange()[0], 0.);
  EXPECT_EQ(map->GetTableRange()[1], 3.);
  for (vtkIdType i = 1; i < map->GetNumberOfTableValues(); ++i) {
    double before[4], here[4];
    map->GetTableValue(i - 1, before);
    map->GetTableValue(i, here);
    EXPECT_GE(luminance(here), luminance(before)) << i;
    if (i % 8 == 0) {
      map->GetTableValue(i - 8, before);
      EXPECT_GT(luminance(here), luminance(before) + 0.01) << i;
    }
  }
}

TEST(ColourMap, IsWhiteAtZeroForValuesOfBothSigns) {
  EXPECT_EQ(colour_range({-1., 4.}), (Range{-4., 4.}));
  const auto map = colour_map({-1., 4.});
  double zero[3];
  map->GetColor(0., zero);
  for (const double channel : zero) EXPECT_NEAR(channel, 247. / 255., 0.01);
  double low[3], high[3];
  map->GetColor(-4., low);
  map->GetColor(4., high);
  EXPECT_GT(low[2], low[0]) << "blue below zero";
  EXPECT_GT(high[0], high[2]) << "red above zero";
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
