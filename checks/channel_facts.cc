#include "checks/channel_facts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/model/words.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/significant_digits.h"
#include "signals/record/channel_name.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
using diagnosis::three_digits;

/// Least-squares slope per second, and its share of the variance; nothing when it is not told from
/// noise.
void find_drift(std::span<const double> x, double rate_hz, ChannelFacts& facts) {
  constexpr std::size_t n_parts = 16;
  constexpr double quantile = 4.14;  // of Student's t with 14 degrees of freedom, two-sided 1e-3
  const std::size_t length = x.size() / n_parts;
  if (length < 2 || facts.rms == 0.) return;
  std::array<double, n_parts> mean{};
  for (std::size_t p = 0; p < n_parts; ++p)
    for (const double v : x.subspan(p * length, length)) mean[p] += v / double(length);
  double slope = 0., square = 0., middle = 0., left = 0.;
  for (const double m : mean) middle += m / double(n_parts);
  for (std::size_t p = 0; p < n_parts; ++p) {
    const double d = double(p) - 0.5 * double(n_parts - 1);
    slope += d * (mean[p] - middle);
    square += d * d;
  }
  slope /= square;
  for (std::size_t p = 0; p < n_parts; ++p) {
    const double d = double(p) - 0.5 * double(n_parts - 1);
    left += std::pow(mean[p] - middle - slope * d, 2);
  }
  const double deviation = std::sqrt(left / double(n_parts - 2) / square);
  if (!(std::abs(slope) > quantile * deviation)) return;
  facts.drift_per_s = slope * rate_hz / double(length);
  const double rise = *facts.drift_per_s * double(x.size()) / rate_hz;
  facts.drift_share = std::min(1., rise * rise / 12. / (facts.rms * facts.rms));
}

std::optional<double> step_of(std::span<const double> x, double range) {
  std::vector<double> values(x.begin(), x.end());
  std::sort(values.begin(), values.end());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] > 1e-9 * range) gaps.push_back(values[i] - values[i - 1]);
  if (gaps.empty()) return std::nullopt;
  const double step = *std::min_element(gaps.begin(), gaps.end());
  const auto on_grid = std::count_if(gaps.begin(), gaps.end(), [&](double gap) {
    return std::abs(gap / step - std::round(gap / step)) < 1e-2;
  });
  // Printed digits give a grid of their own where every value differs from every other.
  const bool repeats = gaps.size() + 1 < x.size() / 2;
  if (!repeats || double(on_grid) < 0.99 * double(gaps.size())) return std::nullopt;
  return step;
}

/// Powers of the lines of the whole record under a Hann window: half the mean square of a tone at
/// a line is in its line.
std::vector<double> line_powers(std::span<const double> x, const double rate_hz) {
  const std::size_t n = x.size();
  std::vector<double> power = signals::welch_spectrum(x, rate_hz, {.segment_samples = n}).density;
  // The noise bandwidth of the window is 1.5 lines, and a tone has 2/3 of its square in the middle.
  const double half_of_a_tone = 0.75 * rate_hz / double(n);
  for (double& p : power) p *= half_of_a_tone;
  return power;
}

/// The line's mean square, when it stands out of its neighbours; nothing otherwise.
std::optional<double> standing_out(const std::vector<double>& power, std::size_t low,
                                   std::size_t high, double false_alarm) {
  constexpr std::size_t main_lobe = 3, reach = 40;
  if (low < main_lobe + reach || high + main_lobe + reach >= power.size()) return std::nullopt;
  double mean = 0., largest = 0.;
  for (std::size_t d = 0; d < reach; ++d)
    for (const double p : {power[low - main_lobe - d], power[high + main_lobe + d]}) {
      mean += p / (2. * double(reach));
      largest = std::max(largest, p);
    }
  const auto peak = *std::max_element(power.begin() + std::ptrdiff_t(low),
                                      power.begin() + std::ptrdiff_t(high) + 1);
  const double n_tried = double(high - low + 1);
  // With 80 neighbours the mean is an estimate: (1 + x / 80)^-80 instead of exp(-x).
  const double chance =
      n_tried * std::pow(1. + peak / mean / (2. * double(reach)), -2. * double(reach));
  // Neighbours as strong belong to a drive with lines of its own.
  constexpr double dominant = 4.;
  if (!(chance < false_alarm) || peak < dominant * largest) return std::nullopt;
  // A line of mean square P has P / 2 in its centre under this window.
  return 2. * peak;
}

void find_hum(std::span<const double> x, double rate_hz, ChannelFacts& facts) {
  constexpr std::size_t fewest = 64;
  if (x.size() < fewest) return;
  constexpr int n_harmonics = 10;
  constexpr double false_alarm = 0.01 / (2 * n_harmonics), grid_share = 2e-3;
  const std::vector<double> power = line_powers(x, rate_hz);
  const double per_line_hz = rate_hz / double(x.size());
  for (const double mains_hz : {50., 60.}) {
    std::vector<HumLine> lines;
    for (int h = 1; h <= n_harmonics; ++h) {
      const double at = h * mains_hz / per_line_hz, off = std::max(1., grid_share * at);
      if (at + off >= double(power.size())) break;
      if (at - off < 0.) continue;
      const auto square = standing_out(power, std::size_t(std::floor(at - off)),
                                       std::size_t(std::ceil(at + off)), false_alarm);
      if (square) lines.push_back({h * mains_hz, std::sqrt(*square)});
    }
    // One line at a multiple may be a resonance.
    if (lines.size() == 1 && lines.front().frequency_hz != mains_hz) continue;
    // 300 Hz is a multiple of both: the mains are those with more lines.
    if (lines.size() > facts.hum.size()) facts.hum = std::move(lines);
  }
}

/// Numbers that a counter of samples passes over; nothing where the channel counts none.
std::optional<std::size_t> skipped_numbers(std::span<const double> x) {
  std::size_t n_skipped = 0;
  std::size_t n_single = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double step = x[i] - x[i - 1];
    if (step < 1. || step > 1e9 || step != std::round(step)) return std::nullopt;
    n_skipped += std::size_t(step) - 1;
    if (step == 1.) ++n_single;
  }
  if (2 * n_single < x.size()) return std::nullopt;
  return n_skipped;
}

/// A counter of samples tells lost ones, as a time does.
Finding counter_finding(const ChannelFacts& facts, const double sampling_rate_hz) {
  const bool is_whole = *facts.skipped == 0;
  std::string text = facts.name + " counts the samples, and ";
  text += is_whole ? "none is missing"
                   : std::to_string(*facts.skipped) +
                         (*facts.skipped == 1 ? " is missing" : " are missing") +
                         ": take it as the time, as in --column 'time=" + facts.name + "*" +
                         signals::rounded(1. / sampling_rate_hz, 8) + "'";
  return {FindingKind::drift,
          facts.name,
          facts.skipped,
          "",
          text,
          is_whole ? Severity::note : Severity::limits};
}

}  // namespace

ChannelFacts channel_facts(const signals::Record& record, const std::string& name) {
  const auto x = record.channel(name);
  ChannelFacts facts{.name = name, .unit = signals::unit_of_ending(signals::unit_at_the_end(name))};
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  facts.lowest = *low;
  facts.highest = *high;
  for (const double v : x) facts.mean += v / double(x.size());
  facts.rms = diagnosis::rms_about_mean(x);
  if (!std::isfinite(facts.rms) || *low == *high) return facts;
  facts.never_falls = std::ranges::is_sorted(x);
  if (facts.never_falls) facts.skipped = skipped_numbers(x);
  if (!facts.never_falls) find_drift(x, record.sampling_rate_hz(), facts);
  facts.step = step_of(x, *high - *low);
  find_hum(x, record.sampling_rate_hz(), facts);
  return facts;
}

void find_channel_faults(const ChannelFacts& facts, const double sampling_rate_hz,
                         std::vector<Finding>& findings) {
  const auto with_unit = [&](double value) {
    return three_digits(value) + (facts.unit.empty() ? "" : " " + facts.unit);
  };
  if (facts.skipped)
    findings.push_back(counter_finding(facts, sampling_rate_hz));
  else if (facts.never_falls)
    findings.push_back({FindingKind::drift, facts.name, facts.highest - facts.lowest, facts.unit,
                        facts.name + " rises from " + with_unit(facts.lowest) + " to " +
                            with_unit(facts.highest) +
                            " and never falls, so it is a time or a counter: name it, as in "
                            "--column 'time=NAME[s]', and its stamps give rate and lost samples",
                        Severity::limits});
  if (facts.drift_per_s) {
    // Above it a model of the response explains less than it leaves (separation/verdict/verdict.h).
    const bool is_most = facts.drift_share > 0.5;
    findings.push_back({FindingKind::drift, facts.name, facts.drift_per_s, facts.unit + "/s",
                        facts.name + " drifts by " + with_unit(*facts.drift_per_s) + "/s, " +
                            diagnosis::percent(facts.drift_share) + " of its variance" +
                            (is_most ? "; warm the electronics up before recording, or high-pass "
                                       "the channel"
                                     : ""),
                        is_most ? Severity::limits : Severity::note});
  }
  // Rounding is like independent noise only from one step rms on (Widrow & Kollar, Quantization
  // Noise, 2008, chapter 5).
  if (facts.step && facts.rms < *facts.step)
    findings.push_back({FindingKind::few_steps, facts.name,
                        (facts.highest - facts.lowest) / *facts.step, "1",
                        facts.name + " has only " +
                            three_digits((facts.highest - facts.lowest) / *facts.step + 1.) +
                            " steps of " + with_unit(*facts.step) +
                            ": rounding hides the signal; choose a smaller range of the converter "
                            "or a higher level",
                        Severity::limits});
  double square = 0.;
  std::string frequencies;
  for (const HumLine& line : facts.hum) {
    square += line.rms * line.rms;
    frequencies += (frequencies.empty() ? "" : ", ") + three_digits(line.frequency_hz);
  }
  if (facts.hum.empty()) return;
  const double share = std::min(1., square / (facts.rms * facts.rms));
  findings.push_back(
      {FindingKind::hum, facts.name, std::sqrt(square), facts.unit,
       facts.name + " has hum at " + frequencies + " Hz: " + with_unit(std::sqrt(square)) + " rms" +
           (share > 0.01 ? ", " + diagnosis::percent(share) + " of its variance" : "") +
           (share > 0.5 ? "; ground and shield the cable" : ""),
       share > 0.5 ? Severity::limits : Severity::note});
}

}  // namespace vibrissa::checks
