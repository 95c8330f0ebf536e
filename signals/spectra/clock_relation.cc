#include "signals/spectra/clock_relation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "signals/base/error.h"
#include "signals/spectra/band_limited_signal.h"
#include "signals/spectra/fft.h"
#include "signals/spectra/shared_motion.h"

namespace vibrissa::signals {

namespace {

using Complex = std::complex<double>;
using Values = std::vector<double>;

[[noreturn]] void refuse() {
  throw UserError(
      "the offset of the two clocks is not told by the motion in both files: they share too little "
      "motion, or it repeats and every repetition fits. Record the start or the end of the motion, "
      "or some knocks at uneven times, with both devices");
}

/// The signal at the lower rate, on its own clock.
Values at_rate(const ClockedSignal& signal, const double rate_hz) {
  const double step = signal.sampling_rate_hz / rate_hz;
  if (step == 1.) return {signal.values.begin(), signal.values.end()};
  const auto between = BandLimitedSignal::at_rate(signal.values, signal.sampling_rate_hz, rate_hz);
  Values values(std::size_t(double(signal.values.size() - 1) / step) + 1);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = between.at(double(i) * step);
  return values;
}

/// Weighted straight line of found over at, without windows that are two samples off.
ClockRelation line_through(std::vector<MatchedWindow> windows) {
  ClockRelation line;
  while (windows.size() >= 3) {
    double weight = 0., at = 0., found = 0., xx = 0., xy = 0.;
    for (const auto& w : windows) {
      weight += w.weight;
      at += w.weight * w.at;
      found += w.weight * w.found;
    }
    at /= weight;
    found /= weight;
    for (const auto& w : windows) {
      xx += w.weight * (w.at - at) * (w.at - at);
      xy += w.weight * (w.at - at) * (w.found - found);
    }
    line.drift = xy / xx - 1.;
    line.offset_s = found - (1. + line.drift) * at;
    const auto error = [&](const MatchedWindow& w) {
      return std::abs(w.found - line.first_time_s(w.at));
    };
    const auto worst = std::ranges::max_element(windows, {}, error);
    constexpr double largest_error = 2.;
    if (error(*worst) <= largest_error) return line;
    windows.erase(worst);
  }
  refuse();
}

ClockRelation coarse(const ClockedSignal& first, const ClockedSignal& other, const double rate_hz,
                     const SharedMotion shared) {
  SharedMotionSearch search;
  // The response of a lightly damped sensor is no single peak.
  if (shared == SharedMotion::response) search.lobe_samples = 64.;
  const Values signal = at_rate(first, rate_hz), pattern = at_rate(other, rate_hz);
  const SharedMotionMatch match = find_shared_motion(signal, pattern, search);
  ClockRelation relation = line_through(match.windows);
  relation.is_opposite = match.is_opposite;
  relation.offset_s =
      first.start_s + relation.offset_s / rate_hz - (1. + relation.drift) * other.start_s;
  return relation;
}

/// Cross-spectra of one stretch of both signals.
struct Block {
  double time_s = 0.;  // of its middle, first clock
  double n_segments = 0.;
  std::vector<Complex> cross;
};

struct Spectra {
  double line_hz = 0., start_s = 0., end_s = 0.;
  std::vector<Block> blocks;
  Values first_power, other_power;
  std::vector<Complex> cross;

  double n_segments() const {
    double n = 0.;
    for (const Block& block : blocks) n += block.n_segments;
    return n;
  }
};

class SegmentSpectra {
 public:
  explicit SegmentSpectra(const std::size_t length) : fft_(length), window_(length) {
    for (std::size_t i = 0; i < length; ++i)
      window_[i] = 0.5 - 0.5 * std::cos(2. * std::numbers::pi * (double(i) + 0.5) / double(length));
  }
  std::vector<Complex> of(const double* const x) {
    double mean = 0.;
    for (std::size_t i = 0; i < window_.size(); ++i) mean += x[i];
    mean /= double(window_.size());
    for (std::size_t i = 0; i < window_.size(); ++i) fft_.time()[i] = window_[i] * (x[i] - mean);
    fft_.forward();
    return {fft_.spectrum().begin(), fft_.spectrum().end()};
  }

 private:
  RealFft fft_;
  Values window_;
};

/// Both signals at even times of the first clock where both are known.
struct Overlap {
  Values first, other;
  double start_s = 0.;
};

class Aligner {
 public:
  Aligner(const ClockedSignal& first, const ClockedSignal& other, const double rate_hz)
      : first_(first),
        other_(other),
        rate_hz_(rate_hz),
        between_first_(reader(first)),
        between_other_(reader(other)) {}

  Overlap at(const ClockRelation& relation) const {
    const double margin_s = BandLimitedSignal::half_length_samples / rate_hz_;
    const double from = std::max(first_.start_s, relation.first_time_s(other_.start_s)) + margin_s;
    const double to = std::min(end_of(first_), relation.first_time_s(end_of(other_))) - margin_s;
    Overlap overlap{{}, {}, from};
    for (double i = 0.; from + i / rate_hz_ <= to; i += 1.) {
      const double t = from + i / rate_hz_;
      overlap.first.push_back(between_first_.at((t - first_.start_s) * first_.sampling_rate_hz));
      overlap.other.push_back(
          between_other_.at((relation.other_time_s(t) - other_.start_s) * other_.sampling_rate_hz));
    }
    return overlap;
  }

 private:
  static double end_of(const ClockedSignal& signal) {
    return signal.start_s + double(signal.values.size() - 1) / signal.sampling_rate_hz;
  }
  BandLimitedSignal reader(const ClockedSignal& signal) const {
    return BandLimitedSignal::at_rate(signal.values, signal.sampling_rate_hz, rate_hz_);
  }

  const ClockedSignal& first_;
  const ClockedSignal& other_;
  double rate_hz_;
  BandLimitedSignal between_first_, between_other_;
};

Spectra block_spectra(const Overlap& overlap, const double rate_hz) {
  constexpr std::size_t shortest = 64, longest = 512, segments_each = 16, most_blocks = 32;
  const std::size_t n = overlap.first.size();
  const std::size_t length = std::clamp(std::bit_floor(n / segments_each), shortest, longest);
  if (n < 4 * length) refuse();
  const std::size_t n_segments = 2 * (n - length) / length + 1;
  const std::size_t n_blocks = std::min(n_segments, most_blocks);
  SegmentSpectra spectra(length);
  Spectra result;
  result.line_hz = rate_hz / double(length);
  result.start_s = overlap.start_s;
  result.end_s = overlap.start_s + double(n) / rate_hz;
  const std::size_t n_lines = length / 2 + 1;
  result.blocks.resize(n_blocks, {0., 0., std::vector<Complex>(n_lines)});
  result.first_power.resize(n_lines);
  result.other_power.resize(n_lines);
  result.cross.resize(n_lines);
  for (std::size_t s = 0; s < n_segments; ++s) {
    const std::size_t at = s * length / 2;
    const auto x = spectra.of(overlap.first.data() + at), y = spectra.of(overlap.other.data() + at);
    Block& block = result.blocks[s * n_blocks / n_segments];
    block.time_s += overlap.start_s + (double(at) + 0.5 * double(length)) / rate_hz;
    block.n_segments += 1.;
    for (std::size_t k = 0; k < n_lines; ++k) {
      const Complex cross = std::conj(x[k]) * y[k];
      result.first_power[k] += std::norm(x[k]);
      result.other_power[k] += std::norm(y[k]);
      result.cross[k] += cross;
      block.cross[k] += cross;
    }
  }
  for (Block& block : result.blocks) block.time_s /= block.n_segments;
  return result;
}

/// Of unrelated noise the coherence of n segments is above this in one line of a hundred.
double coherence_of_noise(const double n) {
  return 1. - std::pow(0.01, 1. / (n - 1.));
}

/// Normal equations of the phases p0 + p1 (t - middle), times 2 pi f.
struct PhaseFit {
  double middle_s = 0., p0 = 0., p1 = 0.;  // p0 in seconds
  double v00 = 0., v01 = 0., v11 = 0.;     // covariance
};

class PhaseSums {
 public:
  void add(const double phase, const double of_p0, const double of_p1, const double weight) {
    a00_ += weight * of_p0 * of_p0;
    a01_ += weight * of_p0 * of_p1;
    a11_ += weight * of_p1 * of_p1;
    b0_ += weight * phase * of_p0;
    b1_ += weight * phase * of_p1;
    c_ += weight * phase * phase;
    n_ += 1.;
  }
  PhaseFit solve(const double middle_s, const bool knows_offset) const {
    PhaseFit fit{.middle_s = middle_s};
    if (n_ < 4. || a11_ <= 0.) refuse();
    const double determinant = a00_ * a11_ - a01_ * a01_;
    if (knows_offset && !(determinant > 0.)) refuse();
    fit.p0 = knows_offset ? (a11_ * b0_ - a01_ * b1_) / determinant : 0.;
    fit.p1 = knows_offset ? (a00_ * b1_ - a01_ * b0_) / determinant : b1_ / a11_;
    const double left = c_ - fit.p0 * b0_ - fit.p1 * b1_;
    // Lines of a Hann window share noise: 1 + 2 (2/3)^2 + 2 (1/6)^2.
    constexpr double of_neighbours = 35. / 18.;
    const double scale = of_neighbours * std::max(1., left / (n_ - 2.));
    fit.v00 = knows_offset ? scale * a11_ / determinant : 0.;
    fit.v01 = knows_offset ? -scale * a01_ / determinant : 0.;
    fit.v11 = knows_offset ? scale * a00_ / determinant : scale / a11_;
    return fit;
  }

 private:
  double a00_ = 0., a01_ = 0., a11_ = 0., b0_ = 0., b1_ = 0., c_ = 0., n_ = 0.;
};

PhaseFit fit_phases(const Spectra& spectra, const double rate_hz, const SharedMotion shared,
                    const bool is_opposite) {
  const double n = spectra.n_segments(), middle = 0.5 * (spectra.start_s + spectra.end_s);
  PhaseSums sums;
  const double highest_hz = BandLimitedSignal::flat_share * rate_hz;
  for (std::size_t k = 1; double(k) * spectra.line_hz < highest_hz; ++k) {
    const double power = spectra.first_power[k] * spectra.other_power[k];
    const double coherence = power > 0. ? std::norm(spectra.cross[k]) / power : 0.;
    if (coherence < coherence_of_noise(n)) continue;
    const Complex reference = shared == SharedMotion::response ? spectra.cross[k]
                              : is_opposite                    ? Complex(-1.)
                                                               : Complex(1.);
    const double w = 2. * std::numbers::pi * double(k) * spectra.line_hz;
    for (const Block& block : spectra.blocks) {
      const double weight = 2. * block.n_segments * coherence / std::max(1e-9, 1. - coherence);
      sums.add(std::arg(block.cross[k] * std::conj(reference)), w, w * (block.time_s - middle),
               weight);
    }
  }
  return sums.solve(middle, shared == SharedMotion::quantity);
}

void correct(ClockRelation& relation, const PhaseFit& fit) {
  relation.offset_s += fit.p0 + fit.p1 * (relation.offset_s - fit.middle_s);
  relation.drift = (1. + relation.drift) * (1. + fit.p1) - 1.;
}

}  // namespace

ClockRelation relate_clocks(const ClockedSignal& first, const ClockedSignal& other,
                            const SharedMotion shared) {
  const double rate_hz = std::min(first.sampling_rate_hz, other.sampling_rate_hz);
  ClockRelation relation = coarse(first, other, rate_hz, shared);
  const Aligner aligner(first, other, rate_hz);
  constexpr int n_steps = 5;
  PhaseFit fit;
  for (int i = 0; i < n_steps; ++i) {
    fit = fit_phases(block_spectra(aligner.at(relation), rate_hz), rate_hz, shared,
                     relation.is_opposite);
    correct(relation, fit);
  }
  const double from_middle = relation.first_time_s(other.start_s) - fit.middle_s;
  relation.drift_deviation = std::sqrt(fit.v11);
  relation.offset_deviation_s = std::sqrt(
      std::max(0., fit.v00 + 2. * from_middle * fit.v01 + from_middle * from_middle * fit.v11));
  return relation;
}

}  // namespace vibrissa::signals
