#include "report/modes/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

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

Colour between(const std::span<const Colour> stops, const double part) {
  const double at = part * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double weight = at - static_cast<double>(below);
  Colour colour{};
  for (std::size_t channel = 0; channel < colour.size(); ++channel)
    colour[channel] = static_cast<unsigned char>(
        std::lround((1. - weight) * stops[below][channel] + weight * stops[below + 1][channel]));
  return colour;
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

std::array<Colour, n_map_colours> colour_map(const Range& values) {
  const auto stops = has_both_signs(values) ? std::span<const Colour>(blue_white_red)
                                            : std::span<const Colour>(viridis);
  std::array<Colour, n_map_colours> map{};
  for (std::size_t i = 0; i < map.size(); ++i)
    map[i] = between(stops, static_cast<double>(i) / static_cast<double>(map.size() - 1));
  return map;
}

}  // namespace vibrissa::report
