#include "meshes/layers.h"

#include <cassert>
#include <cmath>

namespace vibrissa::meshes {

namespace {

double graded_from_lower(const double s, const double growth) {
  return std::expm1(s * std::log(growth)) / (growth - 1.);
}

double graded_fraction(const double s, const double growth, const FineEnd fine_end) {
  switch (fine_end) {
    case FineEnd::lower:
      return graded_from_lower(s, growth);
    case FineEnd::upper:
      return 1. - graded_from_lower(1. - s, growth);
    case FineEnd::both:
      return s <= 0.5 ? 0.5 * graded_from_lower(2. * s, growth)
                      : 1. - 0.5 * graded_from_lower(2. * (1. - s), growth);
  }
  assert(false);
  return s;
}

}  // namespace

std::vector<double> graded_heights(const double lower, const double upper,
                                   const unsigned int n_layers, const double growth,
                                   const FineEnd fine_end) {
  assert(lower < upper && n_layers > 0 && growth > 1.);
  std::vector<double> heights(n_layers + 1);
  for (unsigned int i = 1; i < n_layers; ++i)
    heights[i] = lower + (upper - lower) *
                             graded_fraction(static_cast<double>(i) / n_layers, growth, fine_end);
  heights.front() = lower;
  heights.back() = upper;
  return heights;
}

}  // namespace vibrissa::meshes
