#include "signals/spectra/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/number_text.h"
#include "signals/spectra/channel_check.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double ratio_or_zero(double numerator, double denominator) {
  return denominator > 0. ? numerator / denominator : 0.;
}

// Sums over blocks (periods or segments) of the spectra and their products, line by line.
struct SpectralSums {
  explicit SpectralSums(std::size_t n_lines)
      : input(n_lines),
        output(n_lines),
        cross(n_lines),
        input_power(n_lines),
        output_power(n_lines) {}

  void add(std::span<const std::complex<double>> u, std::span<const std::complex<double>> y) {
    ++n_blocks;
    for (std::size_t k = 0; k < u.size(); ++k) {
      input[k] += u[k];
      output[k] += y[k];
      cross[k] += std::conj(u[k]) * y[k];
      input_power[k] += std::norm(u[k]);
      output_power[k] += std::norm(y[k]);
    }
  }

  double coherence(std::size_t k) const {
    const double bound = input_power[k] * output_power[k];
    return std::min(1., ratio_or_zero(std::norm(cross[k]), bound));
  }

  std::size_t n_blocks = 0;
  std::vector<std::complex<double>> input, output, cross;
  std::vector<double> input_power, output_power;
};

// Zero frequency and half the sampling rate are excluded: the first contains the offsets of the
// sensors, the second is its own alias.
std::size_t n_usable_lines(std::size_t n) {
  return (n + 1) / 2;
}

struct PeriodSpectra {
  std::vector<std::vector<std::complex<double>>> input, output;  // [period][line]
};

PeriodSpectra spectra_of_periods(std::span<const double> input, std::span<const double> output,
                                 std::size_t period_samples) {
  const std::size_t n_periods = input.size() / period_samples;
  RealFft fft(period_samples);
  PeriodSpectra spectra;
  const auto transform = [&](std::span<const double> x) {
    std::ranges::copy(x, fft.time().begin());
    fft.forward();
    return std::vector(fft.spectrum().begin(), fft.spectrum().end());
  };
  for (std::size_t p = 0; p < n_periods; ++p) {
    const std::size_t start = input.size() - (n_periods - p) * period_samples;
    spectra.input.push_back(transform(input.subspan(start, period_samples)));
    spectra.output.push_back(transform(output.subspan(start, period_samples)));
  }
  return spectra;
}

std::vector<std::size_t> excited_lines(const SpectralSums& sums, std::size_t period_samples,
                                       double threshold) {
  double largest = 0., total = 0.;
  for (const auto& line : sums.input) total += std::norm(line);
  for (std::size_t k = 1; k < n_usable_lines(period_samples); ++k)
    largest = std::max(largest, std::norm(sums.input[k]));
  // Rounding errors of a constant are not an excitation.
  if (!(largest > 1e-26 * total))
    throw UserError("frequency response: the input excites no line of the period of " +
                    std::to_string(period_samples) + " samples");
  std::vector<std::size_t> lines;
  for (std::size_t k = 1; k < n_usable_lines(period_samples); ++k)
    if (std::norm(sums.input[k]) >= threshold * largest) lines.push_back(k);
  return lines;
}

// Deviation of the mean over periods: E|error|^2 = scatter / (n (n - 1)).
double deviation_between_periods(const PeriodSpectra& spectra, std::size_t line,
                                 std::complex<double> response, double mean_input) {
  const auto n = static_cast<double>(spectra.input.size());
  if (n < 2.) return not_a_number;
  double scatter = 0.;
  for (std::size_t p = 0; p < spectra.input.size(); ++p)
    scatter += std::norm(spectra.output[p][line] - response * spectra.input[p][line]);
  return std::sqrt(scatter / (n * (n - 1.))) / mean_input;
}

// A periodic Hann window, whose half overlapped copies add up to a constant.
std::vector<double> hann(std::size_t n) {
  std::vector<double> window(n);
  for (std::size_t i = 0; i < n; ++i)
    window[i] = 0.5 - 0.5 * std::cos(2. * std::numbers::pi * static_cast<double>(i) /
                                     static_cast<double>(n));
  return window;
}

// Half overlapped segments, windowed, their mean removed.
class Segments {
 public:
  Segments(std::size_t n_samples, const WelchOptions& options, std::size_t n_needed)
      : length_(checked_length(options)), hop_(length_ / 2), window_(hann(length_)), fft_(length_) {
    n_segments_ = n_samples < length_ ? 0 : 1 + (n_samples - length_) / hop_;
    if (n_segments_ < n_needed)
      throw UserError("Welch: " + std::to_string(n_samples) + " samples contain " +
                      std::to_string(n_segments_) + " segments of " + std::to_string(length_) +
                      " samples, but at least " + std::to_string(n_needed) +
                      " segments are needed; take shorter segments or a longer record");
  }

  std::size_t n_segments() const { return n_segments_; }
  std::size_t n_bins() const { return fft_.n_bins(); }
  double window_power() const {
    return std::inner_product(window_.begin(), window_.end(), window_.begin(), 0.);
  }

  /// Spectrum of one segment, valid until the next call.
  std::span<const std::complex<double>> spectrum(std::span<const double> x, std::size_t segment) {
    const auto part = x.subspan(segment * hop_, length_);
    const double mean =
        std::accumulate(part.begin(), part.end(), 0.) / static_cast<double>(length_);
    for (std::size_t i = 0; i < length_; ++i) fft_.time()[i] = window_[i] * (part[i] - mean);
    fft_.forward();
    return fft_.spectrum();
  }

  /// Equivalent number of independent segments (Welch 1967, for white noise).
  double n_effective() const {
    const double overlap = std::inner_product(window_.begin() + static_cast<std::ptrdiff_t>(hop_),
                                              window_.end(), window_.begin(), 0.) /
                           window_power();
    const auto n = static_cast<double>(n_segments_);
    return n / (1. + 2. * overlap * overlap * (n - 1.) / n);
  }

 private:
  static std::size_t checked_length(const WelchOptions& options) {
    if (options.segment_samples < 8)
      throw UserError("Welch: segment_samples = " + std::to_string(options.segment_samples) +
                      " must be at least 8");
    return options.segment_samples;
  }

  std::size_t length_, hop_, n_segments_ = 0;
  std::vector<double> window_;
  RealFft fft_;
};

double line_frequency(std::size_t line, double sampling_rate_hz, std::size_t n) {
  return static_cast<double>(line) * sampling_rate_hz / static_cast<double>(n);
}

}  // namespace

FrequencyResponse periodic_response(std::span<const double> input, std::span<const double> output,
                                    double sampling_rate_hz, std::size_t period_samples,
                                    double excitation_threshold) {
  check_channels("frequency response", input, output, sampling_rate_hz);
  if (period_samples == 0 || input.size() < period_samples)
    throw UserError("frequency response: " + std::to_string(input.size()) +
                    " samples contain no whole period of " + std::to_string(period_samples));
  if (!(excitation_threshold > 0. && excitation_threshold <= 1.))
    throw UserError("frequency response: excitation threshold " + to_text(excitation_threshold) +
                    " must be above 0 and at most 1");

  const PeriodSpectra spectra = spectra_of_periods(input, output, period_samples);
  SpectralSums sums(spectra.input.front().size());
  for (std::size_t p = 0; p < spectra.input.size(); ++p)
    sums.add(spectra.input[p], spectra.output[p]);

  FrequencyResponse result;
  const auto n_periods = static_cast<double>(sums.n_blocks);
  for (const std::size_t k : excited_lines(sums, period_samples, excitation_threshold)) {
    const std::complex<double> response = sums.output[k] / sums.input[k];
    result.frequency_hz.push_back(line_frequency(k, sampling_rate_hz, period_samples));
    result.value.push_back(response);
    result.coherence.push_back(sums.n_blocks < 2 ? not_a_number : sums.coherence(k));
    result.standard_deviation.push_back(
        deviation_between_periods(spectra, k, response, std::abs(sums.input[k]) / n_periods));
  }
  return result;
}

FrequencyResponse welch_response(std::span<const double> input, std::span<const double> output,
                                 double sampling_rate_hz, const WelchOptions& options) {
  check_channels("frequency response", input, output, sampling_rate_hz);
  Segments segments(input.size(), options, 2);
  if (is_constant(input))
    throw UserError("frequency response: the input is constant and excites no line");
  SpectralSums sums(segments.n_bins());
  std::vector<std::complex<double>> input_spectrum(segments.n_bins());
  for (std::size_t s = 0; s < segments.n_segments(); ++s) {
    std::ranges::copy(segments.spectrum(input, s), input_spectrum.begin());
    sums.add(input_spectrum, segments.spectrum(output, s));
  }

  FrequencyResponse result;
  const double n_effective = segments.n_effective();
  for (std::size_t k = 1; k < n_usable_lines(options.segment_samples); ++k) {
    const double power = sums.input_power[k], coherence = sums.coherence(k);
    const double variance = (1. - coherence) * sums.output_power[k] / (power * n_effective);
    result.frequency_hz.push_back(line_frequency(k, sampling_rate_hz, options.segment_samples));
    result.value.push_back(power > 0. ? sums.cross[k] / power : not_a_number);
    result.coherence.push_back(coherence);
    result.standard_deviation.push_back(power > 0. ? std::sqrt(variance) : not_a_number);
  }
  return result;
}

double welch_averages(const std::size_t n_samples, const WelchOptions& options) {
  return Segments(n_samples, options, 1).n_effective();
}

PowerSpectrum welch_spectrum(std::span<const double> x, double sampling_rate_hz,
                             const WelchOptions& options) {
  check_channel("frequency response", x, "signal", sampling_rate_hz);
  Segments segments(x.size(), options, 1);
  PowerSpectrum result{.frequency_hz = {}, .density = std::vector<double>(segments.n_bins(), 0.)};
  for (std::size_t s = 0; s < segments.n_segments(); ++s) {
    const auto spectrum = segments.spectrum(x, s);
    for (std::size_t k = 0; k < spectrum.size(); ++k) result.density[k] += std::norm(spectrum[k]);
  }
  const double two_sided = 1. / (sampling_rate_hz * segments.window_power() *
                                 static_cast<double>(segments.n_segments()));
  for (std::size_t k = 0; k < result.density.size(); ++k) {
    const bool has_mirror_image = k > 0 && k < n_usable_lines(options.segment_samples);
    result.density[k] *= has_mirror_image ? 2. * two_sided : two_sided;
    result.frequency_hz.push_back(line_frequency(k, sampling_rate_hz, options.segment_samples));
  }
  return result;
}

}  // namespace vibrissa::signals
