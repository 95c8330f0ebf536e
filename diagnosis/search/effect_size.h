#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {

/// Parameters that make an effect vanish when they are neutral, with the others as at its first
/// start: the first parameter that does so alone, otherwise all that are not neutral there.
/// Determined by simulation of a small record with base motion on both axes and wind.
std::vector<std::size_t> size_parameters(const Effect& effect);

/// Share of a start at which an effect is linear in its size (a direction).
inline constexpr double faint_share = 1e-3;

/// A family of values of one effect, from neutral (share 0) to one of its starts (share 1) and
/// beyond. Its size parameters are proportional to their distance from neutral (in the logarithm,
/// where the neutral value lies within a logarithmic range); the others are fixed. Proven by
/// tests/diagnosis/search/effect_size_test.cc.
class EffectFamily {
 public:
  EffectFamily(const Effect& effect, const std::vector<std::size_t>& size_parameters,
               std::vector<double> start);

  std::vector<double> values(double share) const;
  /// The first size parameter, and the share at which it reaches the far bound of its prior.
  std::size_t parameter() const { return sized_.front(); }
  double largest_share() const { return largest_share_; }

 private:
  double share_at(double value) const;

  const Effect& effect_;
  std::vector<std::size_t> sized_;
  std::vector<double> start_;
  double largest_share_ = 0.;
};

}  // namespace vibrissa::diagnosis
