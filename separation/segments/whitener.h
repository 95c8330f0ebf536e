#pragma once

#include <span>
#include <vector>

#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

/// The autoregression x[n] = sum_j a[j] x[n - 1 - j] + e[n] of a signal by Yule's and Walker's
/// equations, and what it leaves of any other. Proven by
/// tests/separation/segments/whitener_test.cc.
class Whitener {
 public:
  /// Throws UserError unless the signal has at least four samples a tap.
  Whitener(std::span<const double> signal, std::size_t n_taps);
  /// e of this signal; as many samples fewer as there are taps.
  std::vector<double> apply(std::span<const double> signal) const;
  std::size_t n_taps() const { return taps_.size(); }

 private:
  std::vector<double> taps_;
};

/// Segments with both channels filtered alike. Under the zero_order, first_order and band_limited
/// holds alike the model from one channel to the other stays the same.
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
