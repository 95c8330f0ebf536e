#include "diagnosis/checks/data_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "diagnosis/model/words.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/is_constant.h"
#include "signals/base/median.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
using signals::is_constant;
namespace channel = signals::channel;

std::string hint(const DatasetRecord& entry, const std::string& name) {
  const bool exchanged = name == channel::base_acceleration && !entry.excitation.wind &&
                         entry.record.has(channel::wind_speed) &&
                         !is_constant(entry.record.channel(channel::wind_speed));
  return exchanged ? " (wind_speed_m_s varies instead: check whether the columns are exchanged)"
                   : "";
}

void check_constant(const DatasetRecord& entry, const std::string& name,
                    std::vector<Finding>& findings) {
  if (!entry.record.has(name)) return;
  const auto x = entry.record.channel(name);
  if (!is_constant(x)) return;
  if (name == channel::wind_speed && x.front() != 0.) {
    findings.push_back({FindingKind::steady_wind, entry.name,
                        "wind_speed_m_s is constant at " + three_digits(x.front()) +
                            ": the response to changes of the wind cannot be determined"});
    return;
  }
  findings.push_back({FindingKind::constant_channel, entry.name,
                      name + " is constant at " + three_digits(x.front() + 0.) +  // no minus zero
                          " although the excitation is " + to_string(entry.excitation) +
                          hint(entry, name) +
                          "; correct the record or remove it from dataset.json"});
}

/// Consecutive equal samples.
struct Run {
  std::size_t first = 0, count = 0;
};

/// The longest run in which x is constant and y is not. Runs at the extreme values are left out:
/// they belong to clipping.
Run longest_run(std::span<const double> x, std::span<const double> y) {
  const auto [low, high] = std::ranges::minmax(x);
  Run longest;
  for (std::size_t first = 0; first < x.size();) {
    std::size_t end = first + 1;
    while (end < x.size() && x[end] == x[first]) ++end;
    const bool extreme = x[first] == low || x[first] == high;
    if (!extreme && end - first > longest.count && !is_constant(y.subspan(first, end - first)))
      longest = {first, end - first};
    first = end;
  }
  return longest;
}

/// A drive that ended: from the run to the end of the record the base rests, and the moment decays.
bool is_free_decay(std::span<const double> x, std::span<const double> y, const Run& run) {
  constexpr double at_rest = 1e-9, decayed = 0.8;
  const auto [low, high] = std::ranges::minmax(x);
  const double rest = at_rest * (high - low);
  if (!std::ranges::all_of(x.subspan(run.first), [&](double a) { return std::abs(a) <= rest; }))
    return false;
  const auto decay = y.subspan(run.first);
  const std::size_t half = decay.size() / 2;
  return rms_about_mean(decay.last(half)) < decayed * rms_about_mean(decay.first(half));
}

void check_stuck(const DatasetRecord& entry, const std::string& name, const std::string& mover,
                 std::vector<Finding>& findings) {
  if (!entry.record.has(name) || !entry.record.has(mover)) return;
  const auto x = entry.record.channel(name), y = entry.record.channel(mover);
  // A channel that is read ten times too fast repeats each sample ten times; lost samples give
  // longer runs.
  constexpr std::size_t fewest_samples = 32;
  const Run run = longest_run(x, y);
  if (run.count < fewest_samples || is_free_decay(x, y, run)) return;
  // With a converter of few steps any value may last for many samples.
  if (std::set<double>(x.begin(), x.end()).size() < x.size() / 8) return;
  findings.push_back({FindingKind::stuck_channel, entry.name,
                      name + " stays at " + three_digits(x[run.first]) + " for " +
                          std::to_string(run.count) + " samples from " +
                          three_digits(entry.record.time_s(run.first)) + " s on while " + mover +
                          " varies: samples were lost; use the part before or after"});
}

/// A moment decays over many samples after an impact: a single sample far above both of its
/// neighbours is a fault.
void check_spikes(const DatasetRecord& entry, std::vector<Finding>& findings) {
  const auto x = entry.record.channel(channel::base_moment);
  std::vector<double> sizes(x.begin(), x.end());
  for (double& v : sizes) v = std::abs(v);
  const double median = signals::median(sizes);
  constexpr double above_all = 30., above_neighbours = 10.;
  for (std::size_t i = 1; i + 1 < x.size() && median > 0.; ++i) {
    if (!(sizes[i] > above_all * median) ||
        sizes[i] < above_neighbours * std::max(sizes[i - 1], sizes[i + 1]))
      continue;
    findings.push_back({FindingKind::spike, entry.name,
                        "base_moment_N_m jumps to " + three_digits(x[i]) + " for one sample at " +
                            three_digits(entry.record.time_s(i)) +
                            " s, far above its neighbours: this is a fault of the recording; use "
                            "the part before or after"});
    return;
  }
}

/// Colour from which on power lies in tones or narrow bands.
constexpr double coloured = 5.;

/// Share of the power that lies in tones off the lines of the period.
double share_between(const std::vector<double>& power, std::size_t n_periods) {
  std::vector<double> between;
  double all = 0., off = 0.;
  for (std::size_t k = 1; k + 1 < power.size(); ++k) {
    all += power[k];
    if (k % n_periods == 0) continue;
    off += power[k];
    between.push_back(power[k]);
  }
  if (all == 0. || colour(between) < coloured) return 0.;
  return off / all;
}

bool is_coloured(std::span<const double> x) {
  const std::vector<Complex> lines = spectrum_of(x);
  return colour(powers({lines.begin() + 1, lines.end()})) > coloured;
}

bool is_driven(const DatasetRecord& entry) {
  return entry.excitation.base && entry.record.has(channel::base_acceleration);
}

double least_level(const signals::Dataset& dataset, const std::string& name) {
  double least = std::numeric_limits<double>::infinity();
  for (const DatasetRecord& entry : dataset.records)
    if (is_driven(entry)) least = std::min(least, rms_about_mean(entry.record.channel(name)));
  return least;
}

}  // namespace

void check_dead_channels(const DatasetRecord& entry, std::vector<Finding>& findings) {
  if (entry.excitation.base) {
    check_constant(entry, channel::base_acceleration, findings);
    check_stuck(entry, channel::base_acceleration, channel::base_moment, findings);
    check_stuck(entry, channel::base_moment, channel::base_acceleration, findings);
  }
  if (entry.excitation.wind) check_constant(entry, channel::wind_speed, findings);
  if (entry.excitation.base || entry.excitation.wind)
    check_constant(entry, channel::base_moment, findings);
  check_spikes(entry, findings);
}

void check_period(const DatasetRecord& entry, std::vector<Finding>& findings) {
  const std::string& name = channel::base_acceleration;
  const std::size_t period = entry.period_samples, n = entry.record.n_samples();
  if (period == 0 || !entry.excitation.base || !entry.record.has(name)) return;
  if (n % period != 0) {
    findings.push_back({FindingKind::partial_period, entry.name,
                        std::to_string(n) + " samples are not a whole number of periods of " +
                            std::to_string(period) +
                            " samples: the record is treated as not periodic"});
    return;
  }
  constexpr double much = 0.2;
  const double share = share_between(powers(spectrum_of(entry.record.channel(name))), n / period);
  if (share > much)
    findings.push_back(
        {FindingKind::broken_period, entry.name,
         "base_acceleration_m_s2 does not repeat after " + std::to_string(period) +
             " samples: " + three_digits(100. * share) +
             " % of its power lies off the lines of that period; correct period_samples in "
             "dataset.json (0 for a record that does not repeat)"});
}

void check_rest(const signals::Dataset& dataset, std::vector<Finding>& findings) {
  constexpr double much = 0.5;
  const double acceleration = least_level(dataset, channel::base_acceleration),
               moment = least_level(dataset, channel::base_moment);
  for (const DatasetRecord& entry : dataset.records) {
    if (entry.excitation != signals::Excitation{} || !entry.record.has(channel::base_acceleration))
      continue;
    const auto a = entry.record.channel(channel::base_acceleration);
    if (rms_about_mean(a) > much * acceleration && is_coloured(a) &&
        rms_about_mean(entry.record.channel(channel::base_moment)) > much * moment)
      findings.push_back({FindingKind::moves_at_rest, entry.name,
                          "the excitation in dataset.json is none, but the base moves with " +
                              three_digits(rms_about_mean(a)) +
                              " m/s^2 rms and the moment follows: the record gives no noise level; "
                              "correct its excitation in dataset.json"});
  }
}

}  // namespace vibrissa::diagnosis
