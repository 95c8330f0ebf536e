#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "separation/model/input_hold.h"

namespace vibrissa::separation {

/// The base acceleration in the form that the difference equations of the modes need.
struct ShapedInput {
  std::vector<double> node;      // at the samples
  std::vector<double> midpoint;  // half a sample later; for band_limited only, otherwise empty
  std::vector<double> direct;    // input of the direct term
};

/// Filters that convert the samples of a band-limited signal to the nodes of a piecewise linear
/// signal with two nodes for each sample, whose spectrum below half the sampling rate equals that
/// of the signal: band-limited interpolation times 1 / sinc^2(f / (2 rate)), Kaiser window,
/// half_length samples on each side. The images are above 1.5 times the rate. The error is within
/// 0.1 % up to 0.9 of half the sampling rate. A delay by a fraction of a sample is part of the
/// filters. For the other holds the samples are not changed. Proven by
/// tests/separation/model/input_shaper_test.cc.
class InputShaper {
 public:
  static constexpr std::size_t half_length = 32;

  InputShaper(Hold hold, double delay_fraction);

  /// Number of samples that must be known after the present one (and before it).
  std::size_t reach() const { return node_.size() / 2; }
  bool has_midpoints() const { return !midpoint_.empty(); }
  /// From the samples [-reach, n + reach) around x: x[0 .. n) is shaped, without allocation.
  /// midpoint may be null when there are none.
  void shape(const double* x, std::size_t n, double* node, double* midpoint, double* direct) const;

  /// Of the samples from -reach to reach around the present one; empty: samples are not changed.
  const std::vector<double>& node_taps() const { return node_; }
  const std::vector<double>& midpoint_taps() const { return midpoint_; }
  const std::vector<double>& direct_taps() const { return direct_; }

 private:
  std::vector<double> node_, midpoint_, direct_;
};

/// Shapes a whole record; outside its ends it is extended by point reflection.
ShapedInput shape_input(std::span<const double> input, Hold hold, double delay_fraction);

}  // namespace vibrissa::separation
