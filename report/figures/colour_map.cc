#include "report/figures/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "report/figures/palette.h"

namespace vibrissa::report {
namespace {

constexpr std::array<Colour, 9> viridis = {{{68, 1, 84},
                                            {71, 44, 122},
                                            {59, 81, 139},
                                            {44, 113, 142},
                                            {33, 144, 141},
                                            {39, 173, 129},
                                            {92, 200, 99},
                                            {170, 220, 50},
                                            {253, 231, 37}}};
constexpr std::array<Colour, 7> blue_white_red = {{{33, 102, 172},
                                                   {103, 169, 207},
                                                   {209, 229, 240},
                                                   {247, 247, 247},
                                                   {253, 219, 199},
                                                   {239, 138, 98},
                                                   {178, 24, 43}}};

double between(const std::span<const Colour> stops, const double part, const std::size_t channel) {
  const double at = part * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double weight = at - static_cast<double>(below);
  return ((1. - weight) * stops[below][channel] + weight * stops[below + 1][channel]) / 255.;
}

bool has_both_signs(const Range& values) {
  return values.low < 0. && values.high > 0.;
}

}  // namespace

Range colour_range(const Range& values) {
  if (has_both_signs(values)) {
    const double largest = std::max(-values.low, values.high);
    return {-largest, largest};
  }
  if (values.length() > 0.) return values;
  return {values.low, values.low + (values.low == 0. ? 1. : std::abs(values.low))};
}

vtkSmartPointer<vtkLookupTable> colour_map(const Range& values) {
  constexpr int n_colours = 256;
  const auto stops = has_both_signs(values) ? std::span<const Colour>(blue_white_red)
                                            : std::span<const Colour>(viridis);
  const Range range = colour_range(values);
  auto map = vtkSmartPointer<vtkLookupTable>::New();
  map->SetNumberOfTableValues(n_colours);
  map->SetTableRange(range.low, range.high);
  for (int i = 0; i < n_colours; ++i) {
    const double part = i / (n_colours - 1.);
    map->SetTableValue(i, between(stops, part, 0), between(stops, part, 1),
                       between(stops, part, 2));
  }
  return map;
}

}  // namespace vibrissa::report
