#pragma once

#include <array>
#include <cstddef>

namespace vibrissa::report {

using Colour = std::array<unsigned char, 3>;

/// Colours that can be distinguished with any common colour blindness (Okabe and Ito 2008); those
/// with good contrast on white come first. The index wraps around.
inline constexpr std::array<Colour, 8> palette = {{{0, 114, 178},
                                                   {213, 94, 0},
                                                   {0, 158, 115},
                                                   {204, 121, 167},
                                                   {230, 159, 0},
                                                   {86, 180, 233},
                                                   {0, 0, 0},
                                                   {240, 228, 66}}};

inline constexpr Colour palette_colour(const std::size_t number) {
  return palette[number % palette.size()];
}

/// The colour mixed with white; part = 1 leaves it as it is.
inline constexpr Colour tint(const Colour& colour, const double part) {
  Colour mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i)
    mixed[i] = static_cast<unsigned char>(255. - part * (255. - colour[i]) + 0.5);
  return mixed;
}

}  // namespace vibrissa::report
