#include "diagnosis/checks/data_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "diagnosis/model/words.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/source_samples.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/number_text.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

/// Number of samples at the channel's extreme value where this value is a stop: it occurs more
/// often than the next value. (The steps of a converter would fill the next value as well.)
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
    // Zero wind is a natural lower limit and no clipping.
    if (name != channel::wind_speed) n += samples_at_stop(x, -1.);
    if (n > 0)
      findings.push_back({FindingKind::clipped_channel, entry.name,
                          name + " is clipped: " + std::to_string(n) +
                              " samples are at its lowest or highest value; measure at a lower "
                              "level or with a larger range"});
  }
}

void check_repeats(const DatasetRecord& entry, std::vector<Finding>& findings) {
  const auto check = [&](const std::string& name, bool moves) {
    if (!moves || !entry.record.has(name) || !is_held(entry.record.channel(name))) return;
    findings.push_back({FindingKind::repeated_samples, entry.name,
                        three_digits(100. * repeat_share(entry.record.channel(name))) +
                            " % of the samples of " + name +
                            " equal the sample before (sample-and-hold repeats): the channel is "
                            "read faster than its source delivers new samples"});
  };
  check(channel::base_acceleration, entry.excitation.base);
  check(channel::base_moment, entry.excitation.base || entry.excitation.wind);
}

void check_channels(const DatasetRecord& entry, std::vector<Finding>& findings) {
  if (entry.excitation.wind && !entry.record.has(channel::wind_speed))
    findings.push_back({FindingKind::missing_wind, entry.name,
                        "wind_speed_m_s is missing although wind acts: the record is not used, and "
                        "it cannot show effects of wind"});
  if (entry.excitation.base && !entry.record.has(channel::base_acceleration))
    findings.push_back(
        {FindingKind::missing_acceleration, entry.name,
         "base_acceleration_m_s2 is missing although the base moves: the record is not used"});
}

void check_axes(const DatasetRecord& entry, std::vector<Finding>& findings) {
  if (!entry.excitation.base || !entry.record.has(channel::base_acceleration) ||
      !entry.record.has(channel::cross_acceleration))
    return;
  const double axial = rms_about_mean(entry.record.channel(channel::base_acceleration)),
               cross = rms_about_mean(entry.record.channel(channel::cross_acceleration));
  // A stage that is driven along one axis does not move three times as much across it.
  constexpr double too_much = 3.;
  if (cross > too_much * axial && axial > 0.)
    findings.push_back(
        {FindingKind::swapped_columns, entry.name,
         "cross_acceleration_m_s2 is " + three_digits(cross / axial) +
             " times base_acceleration_m_s2 (rms): the two columns seem to be exchanged"});
}

void check_length(const NominalModel& nominal, const DatasetRecord& entry,
                  std::vector<Finding>& findings) {
  const std::size_t n = entry.record.n_samples(), fewest = fewest_samples(nominal, entry);
  if (n < fewest)
    findings.push_back({FindingKind::too_short, entry.name,
                        "the record is not used: " + std::to_string(n) +
                            " samples are too few, because the first samples contain transients; "
                            "record at least " +
                            std::to_string(fewest) +
                            " samples, or whole periods in steady state (period_samples)"});
}

void check_setup(const DatasetRecord& entry, std::vector<Finding>& findings) {
  if (!is_simulated(entry.setup))
    findings.push_back(
        {FindingKind::unsimulated_setup, entry.name,
         to_string(entry.setup) +
             ": the record is not used, because this setup cannot be simulated: neither the "
             "sensor's moment of inertia nor the coil's force is known"});
}

/// Adds one finding for each sampling rate.
void check_rates(const signals::Dataset& real, double simulated_rate_hz,
                 std::vector<Finding>& findings) {
  std::map<double, std::vector<std::string>> by_rate;
  for (const DatasetRecord& entry : real.records)
    by_rate[entry.record.sampling_rate_hz()].push_back(entry.name);
  for (const auto& [rate_hz, names] : by_rate)
    if (simulated_rate_hz > 0. && std::abs(rate_hz / simulated_rate_hz - 1.) > 1e-3)
      findings.push_back({FindingKind::different_rate,
                          by_rate.size() > 1 ? joined(names, ", ") : "",
                          "sampled at " + signals::to_text(rate_hz) + " Hz, the simulation at " +
                              signals::to_text(simulated_rate_hz) +
                              " Hz: they are compared at continuous frequencies, which is valid "
                              "below half of both sampling rates"});
}

bool has_one_level(const std::vector<double>& levels) {
  if (levels.empty()) return false;
  constexpr double distinct = 1.3;
  const auto [low, high] = std::ranges::minmax(levels);
  return high < distinct * low;
}

}  // namespace

#define VIBRISSA_AS_TEXT(...) #__VA_ARGS__
#define VIBRISSA_NAMES(...) VIBRISSA_AS_TEXT(__VA_ARGS__)

std::string to_string(const FindingKind kind) {
  std::istringstream names(VIBRISSA_NAMES(VIBRISSA_FINDING_KINDS));
  std::string name;
  for (int i = 0; i <= static_cast<int>(kind); ++i) std::getline(names >> std::ws, name, ',');
  return name;
}

void check_what_is_there(const WantedPaths& wanted, const UsableRecord& is_usable,
                         const signals::Dataset& real, std::vector<Finding>& findings) {
  bool quiet = false, base = false, wind = false, held_out = false;
  std::vector<double> levels;  // of base motion, rms, m/s^2
  for (const DatasetRecord& entry : real.records) {
    const signals::Excitation& moved = entry.excitation;
    const bool fits = entry.split == signals::Split::fit;
    if (!is_usable(entry)) continue;
    held_out |= !fits && (moved.base || moved.wind);
    quiet |= fits && !moved.base && !moved.wind;
    base |= fits && moved.base;
    wind |= fits && moved.wind;
    if (fits && moved.base)
      levels.push_back(rms_about_mean(entry.record.channel(channel::base_acceleration)));
  }
  for (const signals::DatasetResponse& entry : real.responses) {
    const bool fits = entry.split == signals::Split::fit;
    (fits ? base : held_out) = true;
    if (fits) levels.push_back(std::ranges::max(entry.level_m_s2));
    quiet = true;  // the noise of a response is known without rest
  }
  const auto add = [&](bool missing, FindingKind kind, const std::string& message) {
    if (missing) findings.push_back({kind, "", message});
  };
  add(!quiet, FindingKind::no_quiet_record,
      "no fit record at rest: drift, hum and the noise of both channels cannot be distinguished "
      "from effects of motion; add a quiet record");
  add(!held_out, FindingKind::no_held_out,
      "no usable held_out record: the improvement (gap closed) cannot be scored");
  add(wanted.base && !base, FindingKind::no_base_motion,
      "no usable fit record with base motion: sensor_gain and drag_error cannot be distinguished, "
      "and effects of the base cannot be detected");
  add(wanted.wind && !wind, FindingKind::no_wind,
      "no usable fit record with wind: sensor_gain and reference_gain cannot be distinguished, and "
      "effects of wind cannot be detected");
  add(has_one_level(levels), FindingKind::one_level,
      "base motion at one level only: hardening < 0, softening_history and joint_friction cannot "
      "be distinguished, and effects that depend on level can hardly be distinguished from those "
      "that do not; add a second level");
}

void check_recording(const DatasetRecord& entry, std::vector<Finding>& findings) {
  check_channels(entry, findings);
  // A clamped stage does not move, and a sensor without its magnet reads nothing.
  if (entry.setup.stage == signals::Stage::clamped) return;
  check_dead_channels(entry, findings);
  check_axes(entry, findings);
  check_period(entry, findings);
  check_samples(entry, findings);
}

void check_samples(const DatasetRecord& entry, std::vector<Finding>& findings) {
  check_clipping(entry, findings);
  check_repeats(entry, findings);
}

std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                const double simulated_rate_hz) {
  std::vector<Finding> findings;
  const double acceleration_noise = channel_noise(real).acceleration_m_s2;
  for (const DatasetRecord& entry : real.records) {
    check_recording(entry, findings);
    check_setup(entry, findings);
    if (entry.setup.stage == signals::Stage::clamped) continue;
    check_length(nominal, entry, findings);
    if (entry.setup == signals::BenchSetup{})
      check_response(nominal, entry, acceleration_noise, findings);
  }
  check_rates(real, simulated_rate_hz, findings);
  check_rest(real, findings);
  check_what_is_there(
      {nominal.has_base, nominal.has_wind},
      [&](const DatasetRecord& entry) { return is_comparable(nominal, entry); }, real, findings);
  return findings;
}

}  // namespace vibrissa::diagnosis
