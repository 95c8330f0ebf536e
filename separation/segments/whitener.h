#pragma once

#include <span>
#include <vector>

#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

/// The autoregression x[n] = sum_j a[j] x[n - 1 - j] + e[n] of a signal by the Yule-Walker
/// equations, and its use as a whitening filter. Proven by
/// tests/separation/segments/whitener_test.cc.
class Whitener {
 public:
  /// Throws UserError unless the signal has at least four samples for each tap.
  Whitener(std::span<const double> signal, std::size_t n_taps);
  /// The residual e of this signal; it is n_taps() samples shorter.
  std::vector<double> apply(std::span<const double> signal) const;
  std::size_t n_taps() const { return taps_.size(); }

 private:
  std::vector<double> taps_;
};

/// Segments with both channels filtered equally. The model from one channel to the other stays the
/// same, for each of the holds zero_order, first_order and band_limited.
class WhitenedSegments {
 public:
  WhitenedSegments(std::span<const Segment> segments, const Whitener& whitener);
  WhitenedSegments(const WhitenedSegments&) = delete;
  WhitenedSegments& operator=(const WhitenedSegments&) = delete;

  std::span<const Segment> segments() const { return segments_; }

 private:
  std::vector<std::vector<double>> signals_;
  std::vector<Segment> segments_;
};

}  // namespace vibrissa::separation
