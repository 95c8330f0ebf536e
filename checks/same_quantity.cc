#include "checks/same_quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "diagnosis/model/words.h"
#include "separation/verdict/coherence.h"
#include "signals/base/is_constant.h"
#include "signals/base/median.h"
#include "signals/base/unit.h"
#include "signals/record/channel_name.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
namespace channel = signals::channel;

std::string unit_of(const std::string& name) {
  return signals::unit_of_ending(signals::unit_at_the_end(name));
}

bool measures(const std::string& unit, const std::string& other) {
  if (unit.empty() || other.empty()) return false;
  try {
    signals::convert_unit(unit, other);
    return true;
  } catch (const signals::UnitError&) {
    return false;
  }
}

/// Ratio of two channels, the first differentiated if asked, at the lines where they are coherent.
struct FlatRatio {
  double factor = 0.;  // negative: opposite sign
  double spread = 0.;  // largest relative deviation of three quarters of the lines
};

std::optional<FlatRatio> flat_ratio(const signals::Record& record, const std::string& one,
                                    const std::string& other, bool differentiated) {
  signals::Record pair(record.sampling_rate_hz(), record.n_samples());
  const auto x = record.channel(one), y = record.channel(other);
  pair.set_channel(channel::base_acceleration, {x.begin(), x.end()});
  pair.set_channel(channel::base_moment, {y.begin(), y.end()});
  const auto found = separation::coherent_lines(pair);
  constexpr std::size_t fewest_lines = 8;
  if (!found || found->lines.size() < fewest_lines) return std::nullopt;
  std::vector<double> real;
  std::vector<std::complex<double>> ratios;
  for (const std::size_t i : found->lines) {
    const double w = 2. * std::numbers::pi * found->response.frequency_hz[i];
    ratios.push_back(found->response.value[i] /
                     (differentiated ? std::complex<double>(0., w) : std::complex<double>(1.)));
    real.push_back(ratios.back().real());
  }
  const double factor = signals::median(real);
  std::vector<double> deviations;
  for (const auto& ratio : ratios) deviations.push_back(std::abs(ratio / factor - 1.));
  std::ranges::sort(deviations);
  return FlatRatio{factor, deviations[deviations.size() * 3 / 4]};
}

/// Factors between the units of one quantity.
constexpr std::array<double, 4> unit_factors{9.80665, 180. / std::numbers::pi, 1e3, 9806.65};

std::optional<double> unit_factor(double ratio) {
  constexpr double tolerance = 0.03;  // of the gain of a sensor
  for (const double factor : unit_factors)
    for (const double f : {factor, 1. / factor})
      if (std::abs(ratio / f - 1.) < tolerance) return f;
  return std::nullopt;
}

void compare(const signals::Record& record, const std::string& one, const std::string& other,
             bool differentiated, std::vector<Finding>& findings) {
  const auto ratio = flat_ratio(record, one, other, differentiated);
  constexpr double flat = 0.1;
  if (!ratio || ratio->spread > flat) return;
  const std::string what = other + " is " + diagnosis::three_digits(ratio->factor) + " times " +
                           (differentiated ? "the derivative of " : "") + one +
                           " at all frequencies: ";
  if (const auto factor = unit_factor(std::abs(ratio->factor)))
    findings.push_back({FindingKind::wrong_unit, other, *factor, "1",
                        what + "one of them is in another unit; give both their units",
                        Severity::limits});
  else if (ratio->factor < 0.)
    findings.push_back({FindingKind::reversed_sign, other, ratio->factor, "1",
                        what + "their axes are opposite; multiply one of them by -1",
                        Severity::note});
}

}  // namespace

void check_same_quantities(const signals::Record& record, std::vector<Finding>& findings) {
  const auto names = record.channel_names();
  const auto varies = [&](const std::string& name) {
    return !signals::is_constant(record.channel(name));
  };
  for (const std::string& one : names)
    for (const std::string& other : names) {
      if (one == other || !varies(one) || !varies(other)) continue;
      const std::string unit = unit_of(one), further = unit_of(other);
      if (one < other && measures(unit, further)) compare(record, one, other, false, findings);
      if (measures(unit + " s-1", further)) compare(record, one, other, true, findings);
    }
}

}  // namespace vibrissa::checks
