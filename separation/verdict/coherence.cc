#include "separation/verdict/coherence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

#include "separation/segments/hit_blocks.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

double coherence_limit(const std::size_t n_lines, const double averages) {
  constexpr double false_alarm = 0.01;
  return 1. - std::pow(false_alarm / static_cast<double>(n_lines), 1. / (averages - 1.));
}

std::optional<CoherentLines> coherent_lines(const signals::Record& record) {
  const auto input = record.channel(signals::channel::base_acceleration);
  constexpr std::size_t shortest = 32, longest = 2048;
  const std::size_t segment = std::clamp(std::bit_floor(input.size() / 8), shortest, longest);
  if (input.size() < 2 * segment) return std::nullopt;
  CoherentLines out{.welch = {.segment_samples = segment}};
  out.response = signals::welch_response(input, record.channel(signals::channel::base_moment),
                                         record.sampling_rate_hz(), out.welch);
  out.averages = signals::welch_averages(input.size(), out.welch);
  out.limit = coherence_limit(out.response.value.size(), out.averages);
  for (std::size_t i = 0; i < out.response.value.size(); ++i)
    if (out.response.coherence[i] > out.limit) out.lines.push_back(i);
  return out;
}

std::optional<Band> hit_band(const signals::Record& record) {
  const auto input = record.channel(signals::channel::base_acceleration);
  if (hits_of(input).empty()) return std::nullopt;
  const Block block = hit_blocks(input).front();
  const std::vector<double> pulse = pulses_of(input.subspan(block.first, block.end - block.first));
  signals::RealFft fft(pulse.size());
  std::ranges::copy(pulse, fft.time().begin());
  fft.forward();
  const auto spectrum = fft.spectrum();
  constexpr double share = 0.1;
  double largest = 0.;
  std::size_t k = 1;
  for (; k < spectrum.size(); ++k) {
    largest = std::max(largest, std::abs(spectrum[k]));
    if (std::abs(spectrum[k]) < share * largest) break;
  }
  const double step = record.sampling_rate_hz() / static_cast<double>(pulse.size());
  return Band{step, static_cast<double>(k - 1) * step};
}

Band coherent_band(const signals::Record& record, const std::optional<CoherentLines>& found) {
  if (const auto hit = hit_band(record)) return *hit;
  if (!found || found->lines.empty()) return {0., record.sampling_rate_hz() / 2.};
  const std::vector<double>& frequency_hz = found->response.frequency_hz;
  return {frequency_hz[found->lines.front()], frequency_hz[found->lines.back()]};
}

}  // namespace vibrissa::separation
