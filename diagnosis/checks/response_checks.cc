#include "diagnosis/checks/data_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "diagnosis/model/words.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/number_text.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

/// Ratio of the measured to the nominal response at lines where the nominal response is large
/// enough.
struct Ratio {
  double median = 1.;
  double spread = 0.;    // interquartile range of its logarithm
  double likeness = 0.;  // normalised correlation of both: -1 for an opposite sign
};

double lowest_mode_hz(const NominalModel& nominal) {
  if (nominal.modes.empty()) return 0.;
  return std::ranges::min(nominal.modes, {}, &StructuralMode::frequency_rad_s).frequency_rad_s /
         (2. * std::numbers::pi);
}

/// Uses the lines up to a frequency that are strong among themselves and among all lines (else they
/// are dominated by noise), and strong as measured (else they may be images of sample-and-hold
/// repeats). Nothing when there are too few such lines.
std::optional<Ratio> ratio_of(const std::span<const Complex> measured,
                              const std::span<const Complex> predicted, const double last_line,
                              const std::size_t fewest_lines) {
  const std::size_t end = measured.size() - 1,
                    n = std::min(end, static_cast<std::size_t>(std::max(0., last_line) + 1.));
  const auto largest = [](const std::span<const Complex> lines) {
    double out = 0.;
    for (const Complex& line : lines.subspan(1)) out = std::max(out, std::abs(line));
    return out;
  };
  const double least = std::max(0.1 * largest(predicted.first(n)),
                                0.02 * largest(predicted.first(end))),
               least_measured = 0.05 * largest(measured.first(n));
  double product = 0., of_measured = 0., of_predicted = 0.;
  std::vector<double> logs;
  for (std::size_t k = 1; k < n; ++k) {
    if (!(std::abs(predicted[k]) > least && std::abs(measured[k]) > least_measured)) continue;
    logs.push_back(std::log(std::abs(measured[k] / predicted[k])));
    product += (measured[k] * std::conj(predicted[k])).real();
    of_measured += std::norm(measured[k]);
    of_predicted += std::norm(predicted[k]);
  }
  if (logs.size() < fewest_lines) return std::nullopt;
  std::ranges::sort(logs);
  return Ratio{std::exp(logs[logs.size() / 2]), logs[3 * logs.size() / 4] - logs[logs.size() / 4],
               product / std::sqrt(of_measured * of_predicted)};
}

/// Both values, as far as the records determine them.
struct Ratios {
  std::optional<Ratio> all, slow;
  /// A shifted mode changes the response near it tenfold, but not well below it.
  double factor() const { return slow ? slow->median : all->median; }
};

Ratios ratios_of(const NominalModel& nominal, const DatasetRecord& entry,
                 const std::vector<Complex>& predicted,
                 const std::string& output = channel::base_moment) {
  // The first mode is above this even when the silicone has a third of its stiffness.
  constexpr double slow = 0.4;
  constexpr std::size_t fewest_slow_lines = 4;
  const std::vector<Complex> measured = spectrum_of(entry.record.channel(output));
  const double slow_line = slow * lowest_mode_hz(nominal) *
                           static_cast<double>(entry.record.n_samples()) /
                           entry.record.sampling_rate_hz();
  return {ratio_of(measured, predicted, static_cast<double>(measured.size()), 1),
          ratio_of(measured, predicted, slow_line, fewest_slow_lines)};
}

/// Factor on the response that a wrong unit causes.
struct UnitMistake {
  double factor;
  const char* message;
};

bool near(double factor, double expected) {
  // Twice the spread of the gains of built sensors, and half the distance between units.
  constexpr double tolerance = 1.6;
  return factor > expected / tolerance && factor < expected * tolerance;
}

void check_factor(double factor, const std::string& record, const std::string& columns,
                  std::span<const UnitMistake> mistakes, std::vector<Finding>& findings) {
  const std::string how_much =
      "the measured response is " + three_digits(factor) + " times the simulated one: ";
  for (const UnitMistake& mistake : mistakes)
    if (near(factor, mistake.factor)) {
      findings.push_back({FindingKind::wrong_unit, record, how_much + mistake.message});
      return;
    }
  // Outside the ranges of all effects together.
  constexpr double implausible = 30.;
  if (factor > implausible || factor < 1. / implausible)
    findings.push_back({FindingKind::wrong_unit, record,
                        how_much + "no sensor deviates that much; check the units of " + columns +
                            " and the connection of every channel"});
}

/// Well below its resonance a sensor's moment depends on its mass and not on its stiffness.
void check_gain(const Ratios& ratios, const std::string& record, std::vector<Finding>& findings) {
  if (!ratios.slow || near(ratios.slow->median, 1.)) return;
  findings.push_back(
      {FindingKind::unlikely_gain, record,
       "well below the first mode the measured response is " + three_digits(ratios.slow->median) +
           " times the simulated one, more than the variation between built sensors: check the "
           "factor from the sensor's reading to base_moment first"});
}

void check_sign(const Ratios& ratios, const std::string& record, const std::string& message,
                std::vector<Finding>& findings) {
  constexpr double opposite = -0.9;
  if (ratios.slow && ratios.slow->likeness < opposite)
    findings.push_back({FindingKind::reversed_sign, record, message});
}

constexpr UnitMistake mistakes_of_base[] = {
    {9.80665,
     "base_acceleration_m_s2 seems to be in g; multiply it by 9.80665 (or --column "
     "'base_acceleration=COLUMN[g]')"},
    {1. / 9.80665,
     "base_acceleration_m_s2 seems to be ten times too large, as m/s^2 taken for g; divide it by "
     "9.80665"},
    {9.80665e-3, "base_acceleration_m_s2 seems to be in milli-g; multiply it by 9.80665e-3"},
    {1e-3, "base_acceleration_m_s2 seems to be in mm/s^2; multiply it by 1e-3"},
    {1e3, "base_moment_N_m seems to be in N mm; multiply it by 1e-3"},
    {1e6, "base_moment_N_m seems to be in mN mm; multiply it by 1e-6"},
    {9.80665e3, "base_acceleration_m_s2 seems to be in g and base_moment_N_m in N mm"},
    {9.80665e6, "base_acceleration_m_s2 seems to be in g and base_moment_N_m in mN mm"}};

constexpr UnitMistake mistakes_of_wind[] = {
    {1. / (3.6 * 3.6), "wind_speed_m_s seems to be in km/h; divide it by 3.6"},
    {1e-4, "wind_speed_m_s seems to be in cm/s; multiply it by 1e-2"},
    {1e-6, "wind_speed_m_s seems to be in mm/s; multiply it by 1e-3"},
    {1e3, "base_moment_N_m seems to be in N mm; multiply it by 1e-3"},
    {1e6, "base_moment_N_m seems to be in mN mm; multiply it by 1e-6"}};

/// Is the excitation larger than its noise?
bool is_driven(const DatasetRecord& entry, double acceleration_noise_m_s2) {
  return mean_square(entry.record.channel(channel::base_acceleration)) >
         9. * acceleration_noise_m_s2 * acceleration_noise_m_s2;
}

/// What the simulation predicts for what moved the sensor, against the reading.
Ratios ratios_to(const NominalModel& nominal, const DatasetRecord& entry) {
  const auto input = [&](const bool moved, const std::string& name) {
    return moved ? entry.record.channel(name) : std::span<const double>();
  };
  return ratios_of(
      nominal, entry,
      nominal_moment(nominal, entry.record.n_samples(), entry.record.sampling_rate_hz(),
                     input(entry.excitation.base, channel::base_acceleration),
                     input(entry.excitation.wind, channel::wind_speed)));
}

/// Are base acceleration and moment exchanged?
bool are_exchanged(const NominalModel& nominal, const DatasetRecord& entry, const Ratio& as_named,
                   std::vector<Finding>& findings) {
  const auto exchanged =
      ratios_of(nominal, entry,
                nominal_moment(nominal, entry.record.n_samples(), entry.record.sampling_rate_hz(),
                               entry.record.channel(channel::base_moment), {}),
                channel::base_acceleration)
          .all;
  const bool implausible = std::abs(std::log10(as_named.median)) > 4.;
  if (!implausible || !exchanged || exchanged->median <= 0.05 || exchanged->median >= 20. ||
      exchanged->spread >= as_named.spread)
    return false;
  findings.push_back(
      {FindingKind::swapped_columns, entry.name,
       "base_acceleration_m_s2 and base_moment_N_m seem to be exchanged: the response is " +
           three_digits(as_named.median) + " times the simulated one, and after the exchange " +
           three_digits(exchanged->median) + " times"});
  return true;
}

void check_base(const NominalModel& nominal, const DatasetRecord& entry, const Ratios& ratios,
                std::vector<Finding>& findings) {
  if (are_exchanged(nominal, entry, *ratios.all, findings)) return;
  const std::size_t n_before = findings.size();
  check_factor(ratios.factor(), entry.name, "base_acceleration_m_s2 and base_moment_N_m",
               mistakes_of_base, findings);
  if (findings.size() == n_before) check_gain(ratios, entry.name, findings);
  check_sign(ratios, entry.name,
             "base_moment_N_m has the wrong sign relative to base_acceleration_m_s2 well below the "
             "first mode: multiply one of them by -1 (the moment is positive for wind in +x, hence "
             "negative for a steady acceleration in +x)",
             findings);
}

void check_wind(const DatasetRecord& entry, const Ratios& ratios, std::vector<Finding>& findings) {
  check_factor(ratios.factor(), entry.name, "wind_speed_m_s and base_moment_N_m", mistakes_of_wind,
               findings);
  check_sign(ratios, entry.name,
             "base_moment_N_m falls when wind_speed_m_s rises, contrary to the simulation: "
             "multiply one of them by -1 (the moment is positive for wind in +x)",
             findings);
}

void check_rate(const NominalModel& nominal, const DatasetRecord& entry,
                std::vector<Finding>& findings) {
  const double mode_hz = lowest_mode_hz(nominal), rate_hz = entry.record.sampling_rate_hz();
  if (0.5 * rate_hz > mode_hz) return;
  const std::string where = "sampled at " + signals::to_text(rate_hz) +
                            " Hz, while the first mode is at " + three_digits(mode_hz) + " Hz: ";
  // A plausible sampling rate is between the first mode's frequency and a thousand times that.
  constexpr double milli = 1e-3;
  const bool in_ms = rate_hz / milli > mode_hz;
  if (rate_hz < 0.1 * mode_hz)
    findings.push_back({FindingKind::wrong_unit, entry.name,
                        where + (in_ms ? "time_s seems to be in ms; multiply it by 1e-3"
                                       : "check the unit of time_s")});
  else
    findings.push_back({FindingKind::slow_rate, entry.name,
                        where + "half the sampling rate is below it, and higher frequencies are "
                                "aliased; sample faster"});
}

}  // namespace

void check_response(const NominalModel& nominal, const DatasetRecord& entry,
                    const double acceleration_noise_m_s2, std::vector<Finding>& findings) {
  const signals::Excitation& moved = entry.excitation;
  if (!nominal.modes.empty() && (moved.base || moved.wind)) check_rate(nominal, entry, findings);
  if (!is_comparable(nominal, entry) || (!moved.base && !moved.wind)) return;
  if (moved.base && !is_driven(entry, acceleration_noise_m_s2)) return;
  const Ratios ratios = ratios_to(nominal, entry);
  if (!ratios.all) return;
  if (moved.base && moved.wind)
    check_factor(ratios.factor(), entry.name,
                 "base_acceleration_m_s2, wind_speed_m_s and base_moment_N_m", mistakes_of_base,
                 findings);
  else if (moved.base)
    check_base(nominal, entry, ratios, findings);
  else
    check_wind(entry, ratios, findings);
}

}  // namespace vibrissa::diagnosis
