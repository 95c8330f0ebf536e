#include "diagnosis/data_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>

#include "diagnosis/repeated_samples.h"
#include "diagnosis/spectrum.h"
#include "diagnosis/words.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

double rms_without_mean(std::span<const double> x) {
  double sum = 0., square = 0.;
  for (const double v : x) sum += v;
  const double mean = sum / static_cast<double>(x.size());
  for (const double v : x) square += (v - mean) * (v - mean);
  return std::sqrt(square / static_cast<double>(x.size()));
}

/// How often a channel takes its extreme value when that is a stop: more often than the value next
/// to it, which the steps of a converter would fill as well.
std::size_t samples_at_stop(std::span<const double> x, double side) {
  std::map<double, std::size_t> counts;
  for (const double v : x) ++counts[-side * v];  // extreme first
  constexpr std::size_t fewest_values = 9, fewest_samples = 6;
  if (counts.size() < fewest_values) return 0;
  const std::size_t extreme = counts.begin()->second, next = std::next(counts.begin())->second;
  return extreme >= fewest_samples && extreme > 3 * next ? extreme : 0;
}

void check_clipping(const DatasetRecord& entry, std::vector<Finding>& findings) {
  for (const std::string& name :
       {channel::base_acceleration, channel::base_moment, channel::wind_speed}) {
    if (!entry.record.has(name)) continue;
    const auto x = entry.record.channel(name);
    std::size_t n = samples_at_stop(x, 1.);
    // Calm is a natural lower stop of wind.
    if (name != channel::wind_speed) n += samples_at_stop(x, -1.);
    if (n > 0)
      findings.push_back({FindingKind::clipped_channel, entry.name,
                          name + " is clipped: " + std::to_string(n) +
                              " samples stand at its extremes; measure at a lower level or range"});
  }
}

/// Measured over nominal response to input at the lines where the nominal one is strong.
struct Ratio {
  double median = 1.;
  double spread = 0.;  // between quartiles of its logarithm
};

std::optional<Ratio> response_ratio(std::span<const double> input, std::span<const double> output,
                                    double rate_hz,
                                    const std::function<Complex(Complex)>& response) {
  const std::vector<Complex> in = spectrum_of(input), out = spectrum_of(output);
  std::vector<double> predicted(in.size(), 0.), logs;
  double largest = 0.;
  for (std::size_t k = 1; k + 1 < in.size(); ++k) {
    const Complex s(0., 2. * std::numbers::pi * rate_hz * static_cast<double>(k) /
                            static_cast<double>(input.size()));
    predicted[k] = std::abs(in[k] * response(s));
    largest = std::max(largest, predicted[k]);
  }
  for (std::size_t k = 1; k + 1 < in.size(); ++k)
    if (predicted[k] > 0.1 * largest) logs.push_back(std::log(std::abs(out[k]) / predicted[k]));
  if (logs.empty()) return std::nullopt;
  std::sort(logs.begin(), logs.end());
  const std::size_t n = logs.size();
  return Ratio{std::exp(logs[n / 2]), logs[3 * n / 4] - logs[n / 4]};
}

std::optional<Ratio> base_ratio(const NominalModel& nominal, const DatasetRecord& entry,
                                bool exchanged) {
  if (!nominal.has_base || !entry.excitation.base || entry.excitation.wind ||
      !entry.record.has(channel::base_acceleration))
    return std::nullopt;
  const auto a = entry.record.channel(channel::base_acceleration);
  const auto m = entry.record.channel(channel::base_moment);
  return response_ratio(exchanged ? m : a, exchanged ? a : m, entry.record.sampling_rate_hz(),
                        [&](Complex s) { return nominal.base_response(s); });
}

std::optional<Ratio> wind_ratio(const NominalModel& nominal, const DatasetRecord& entry) {
  if (!nominal.has_wind || !entry.excitation.wind || entry.excitation.base ||
      !entry.record.has(channel::wind_speed))
    return std::nullopt;
  const auto u = entry.record.channel(channel::wind_speed);
  std::vector<double> force(u.begin(), u.end());
  for (double& value : force) value *= std::abs(value);
  return response_ratio(force, entry.record.channel(channel::base_moment),
                        entry.record.sampling_rate_hz(),
                        [&](Complex s) { return nominal.wind_response(s); });
}

/// A factor of the response that a wrong unit gives.
struct UnitMistake {
  double factor;
  const char* message;
};

bool near(double factor, double expected) {
  // Twice the spread of what a built sensor's gain is off by, and half the way between units.
  constexpr double tolerance = 1.6;
  return factor > expected / tolerance && factor < expected * tolerance;
}

void check_factor(double factor, const std::string& record,
                  const std::vector<UnitMistake>& mistakes, std::vector<Finding>& findings) {
  for (const UnitMistake& mistake : mistakes)
    if (near(factor, mistake.factor))
      findings.push_back({FindingKind::wrong_unit, record,
                          "the measured response is " + three_digits(factor) +
                              " times the simulated one: " + mistake.message});
}

void check_units(const NominalModel& nominal, const DatasetRecord& entry,
                 std::vector<Finding>& findings) {
  static const std::vector<UnitMistake> of_base{
      {9.80665, "base_acceleration_m_s2 seems to be in g; multiply it by 9.80665"},
      {9.80665e-3, "base_acceleration_m_s2 seems to be in milli-g; multiply it by 9.80665e-3"},
      {1e-3, "base_acceleration_m_s2 seems to be in mm/s^2; multiply it by 1e-3"},
      {1e3, "base_moment_N_m seems to be in N mm; multiply it by 1e-3"},
      {1e6, "base_moment_N_m seems to be in mN mm; multiply it by 1e-6"},
      {9.80665e3, "base_acceleration_m_s2 seems to be in g and base_moment_N_m in N mm"},
      {9.80665e6, "base_acceleration_m_s2 seems to be in g and base_moment_N_m in mN mm"}};
  static const std::vector<UnitMistake> of_wind{
      {1. / (3.6 * 3.6), "wind_speed_m_s seems to be in km/h; divide it by 3.6"},
      {1e3, "base_moment_N_m seems to be in N mm; multiply it by 1e-3"},
      {1e6, "base_moment_N_m seems to be in mN mm; multiply it by 1e-6"}};
  if (const auto ratio = base_ratio(nominal, entry, false)) {
    const auto exchanged = base_ratio(nominal, entry, true);
    const bool implausible = std::abs(std::log10(ratio->median)) > 4.;
    if (implausible && exchanged && exchanged->median > 0.05 && exchanged->median < 20. &&
        exchanged->spread < ratio->spread) {
      findings.push_back({FindingKind::swapped_columns, entry.name,
                          "base_acceleration_m_s2 and base_moment_N_m seem to be exchanged: as "
                          "they stand the response is " +
                              three_digits(ratio->median) + " times the simulated one, exchanged " +
                              three_digits(exchanged->median) + " times"});
      return;
    }
    check_factor(ratio->median, entry.name, of_base, findings);
  }
  if (const auto ratio = wind_ratio(nominal, entry))
    check_factor(ratio->median, entry.name, of_wind, findings);
}

void check_repeats(const DatasetRecord& entry, std::vector<Finding>& findings) {
  const auto check = [&](const std::string& name, bool moves) {
    if (!moves || !entry.record.has(name) || !is_polled(entry.record.channel(name))) return;
    findings.push_back({FindingKind::repeated_samples, entry.name,
                        three_digits(100. * repeat_share(entry.record.channel(name))) +
                            " % of the samples of " + name +
                            " equal the one before: it is polled faster than it is renewed"});
  };
  check(channel::base_acceleration, entry.excitation.base);
  check(channel::base_moment, entry.excitation.base || entry.excitation.wind);
}

void check_channels(const DatasetRecord& entry, std::vector<Finding>& findings) {
  if (entry.excitation.wind && !entry.record.has(channel::wind_speed))
    findings.push_back({FindingKind::missing_wind, entry.name,
                        "wind acts but wind_speed_m_s is missing: the record cannot be used, and "
                        "effects of wind cannot be told from it"});
  if (entry.excitation.base && !entry.record.has(channel::base_acceleration))
    findings.push_back({FindingKind::missing_acceleration, entry.name,
                        "the base moves but base_acceleration_m_s2 is missing: the record cannot "
                        "be used"});
}

void check_what_is_there(const signals::Dataset& real, std::vector<Finding>& findings) {
  bool quiet = false, held_out = false;
  std::vector<double> levels;
  for (const DatasetRecord& entry : real.records) {
    if (entry.split == signals::Split::held_out) {
      held_out = true;
      continue;
    }
    quiet |= entry.excitation == signals::Excitation{};
    if (entry.excitation.base && entry.record.has(channel::base_acceleration))
      levels.push_back(rms_without_mean(entry.record.channel(channel::base_acceleration)));
  }
  if (!quiet)
    findings.push_back({FindingKind::no_quiet_record, "",
                        "no fit record at rest: drift, hum and the noise of both channels cannot "
                        "be told from what motion brings"});
  if (!held_out)
    findings.push_back({FindingKind::no_held_out, "",
                        "no held_out record: how far the gap closes cannot be scored"});
  if (levels.empty()) return;
  constexpr double distinct = 1.3;
  if (*std::max_element(levels.begin(), levels.end()) <
      distinct * *std::min_element(levels.begin(), levels.end()))
    findings.push_back({FindingKind::one_level, "",
                        "base motion at one level only: what depends on level (hardening, "
                        "friction, softening) can hardly be told from what does not"});
}

}  // namespace

std::string to_string(const FindingKind kind) {
  switch (kind) {
    case FindingKind::clipped_channel:
      return "clipped_channel";
    case FindingKind::swapped_columns:
      return "swapped_columns";
    case FindingKind::wrong_unit:
      return "wrong_unit";
    case FindingKind::repeated_samples:
      return "repeated_samples";
    case FindingKind::no_quiet_record:
      return "no_quiet_record";
    case FindingKind::one_level:
      return "one_level";
    case FindingKind::missing_wind:
      return "missing_wind";
    case FindingKind::missing_acceleration:
      return "missing_acceleration";
    case FindingKind::no_held_out:
      return "no_held_out";
    case FindingKind::different_rate:
      return "different_rate";
  }
  return "";
}

bool spoils_everything(const FindingKind kind) {
  return kind == FindingKind::swapped_columns || kind == FindingKind::wrong_unit;
}

std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                const double simulated_rate_hz) {
  std::vector<Finding> findings;
  for (const DatasetRecord& entry : real.records) {
    check_channels(entry, findings);
    check_clipping(entry, findings);
    check_repeats(entry, findings);
    check_units(nominal, entry, findings);
    const double rate_hz = entry.record.sampling_rate_hz();
    if (simulated_rate_hz > 0. && std::abs(rate_hz / simulated_rate_hz - 1.) > 1e-3)
      findings.push_back({FindingKind::different_rate, entry.name,
                          "sampled at " + three_digits(rate_hz) + " Hz, the simulation at " +
                              three_digits(simulated_rate_hz) +
                              " Hz: compared in continuous frequency, which is sound below both "
                              "halves"});
  }
  check_what_is_there(real, findings);
  return findings;
}

}  // namespace vibrissa::diagnosis
