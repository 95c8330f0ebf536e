#include "diagnosis/prediction/sweep_states.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "diagnosis/response/linear_response.h"
#include "diagnosis/steady_state/response_curve.h"

namespace vibrissa::diagnosis {
namespace {

constexpr auto n_lanes = static_cast<std::size_t>(signals::n_lanes);

std::vector<double> angular_frequencies(const PreparedRecord& record) {
  std::vector<double> w;
  for (const double hz : record.sines.frequency_hz) w.push_back(2. * std::numbers::pi * hz);
  return w;
}

/// Amplitude of the base acceleration at each line [m/s^2].
std::vector<double> levels(const PreparedRecord& record) {
  std::vector<double> out;
  for (std::size_t b = 0; b < record.n_bins(); ++b)
    out.push_back(std::abs(record.acceleration[b + 1]) / record.sines.per_amplitude);
  return out;
}

/// Piecewise linear in rising x.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, const double at) {
  const auto above = std::ranges::upper_bound(x, at) - x.begin();
  if (above == 0) return y.front();
  if (above == std::ssize(x)) return y.back();
  const auto i = static_cast<std::size_t>(above);
  return std::lerp(y[i - 1], y[i], (at - x[i - 1]) / (x[i] - x[i - 1]));
}

HarmonicDrive drive_of(const PreparedRecord& record) {
  const std::vector<double> level = levels(record);
  HarmonicDrive drive{.acceleration_m_s2 = std::ranges::max(level),
                      .readout = record.readout,
                      .record_number = record.number};
  if (std::ranges::min(level) < drive.acceleration_m_s2)
    drive.relative_level = [w = angular_frequencies(record), level,
                            largest = drive.acceleration_m_s2](const double at) {
      return interpolated(w, level, at) / largest;
    };
  return drive;
}

/// The curve goes on beyond the last line, because a branch to which a sweep jumps may turn back
/// there. Higher harmonics of a hundredth hardly change the fundamental.
ResponseCurve curve_of(const Chain& chain, const PreparedRecord& record) {
  constexpr double further = 1.25, most_neglected = 1e-2;
  constexpr std::size_t highest_order = 9;
  const double lowest = 2. * std::numbers::pi * record.sines.frequency_hz.front(),
               highest = 2. * std::numbers::pi * record.sines.frequency_hz.back();
  const bool up = record.sines.direction == signals::SweepDirection::up;
  return {chain,
          drive_of(record),
          up ? lowest : highest,
          up ? further * highest : lowest / further,
          most_neglected,
          highest_order};
}

std::vector<Complex> readings_at(const HarmonicBalance& balance,
                                 const std::vector<PeriodicMotion>& motions) {
  std::vector<Complex> out;
  for (std::size_t first = 0; first < motions.size(); first += n_lanes) {
    const auto some = std::span(motions).subspan(first, std::min(n_lanes, motions.size() - first));
    const std::vector<Complex> values = balance.readings(some);
    out.insert(out.end(), values.begin(), values.end());
  }
  return out;
}

/// For each line, in the order of the sweep, what choosing each of its stable states costs.
using Costs = std::vector<std::vector<double>>;

/// The choice of least total cost whose index does not fall where several states are stable.
std::vector<std::size_t> cheapest_rising(const Costs& costs) {
  std::vector<std::vector<std::size_t>> before(costs.size());
  std::vector<double> sum;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    std::vector<double> next(costs[i].size());
    for (std::size_t j = 0; j < next.size(); ++j) {
      // From a line with one state every branch that begins or goes on there can be reached.
      const std::size_t n_from =
          sum.size() > 1 && next.size() > 1 ? std::min(j + 1, sum.size()) : sum.size();
      const auto least =
          std::min_element(sum.begin(), sum.begin() + static_cast<std::ptrdiff_t>(n_from));
      before[i].push_back(static_cast<std::size_t>(least - sum.begin()));
      next[j] = costs[i][j] + (sum.empty() ? 0. : *least);
    }
    sum = std::move(next);
  }
  std::vector<std::size_t> out(costs.size(), 0);
  auto last = static_cast<std::size_t>(std::ranges::min_element(sum) - sum.begin());
  for (std::size_t i = costs.size(); i-- > 0;) {
    out[i] = last;
    last = before[i][last];
  }
  return out;
}

/// The stable ones of the states at a line: every second one, from the first.
std::vector<PeriodicMotion> stable(const std::vector<PeriodicMotion>& states) {
  std::vector<PeriodicMotion> out;
  for (std::size_t i = 0; i < states.size(); i += 2) out.push_back(states[i]);
  return out;
}

/// Lines in the order of the sweep.
std::vector<std::size_t> sweep_order(const PreparedRecord& record) {
  std::vector<std::size_t> order(record.n_bins());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (record.sines.direction == signals::SweepDirection::down) std::ranges::reverse(order);
  return order;
}

/// Adds to the lines behind the end of a branch its last state, as the first choice.
void hold_ended_branches(const std::vector<double>& hz, const std::vector<std::size_t>& order,
                         std::vector<std::vector<PeriodicMotion>>& states) {
  const std::vector<std::vector<PeriodicMotion>> own = states;
  std::optional<std::size_t> last;  // line at which a branch ended
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::size_t here = order[i], before = order[i - 1];
    if (own[here].size() > 1)
      last.reset();
    else if (own[before].size() > 1)
      last = before;
    if (last && std::abs(std::log(hz[here] / hz[*last])) < SweepStates::late_jump)
      states[here].insert(states[here].begin(), own[*last].front());
  }
}

/// The stable states of each line, or nothing where a line has none.
std::vector<std::vector<PeriodicMotion>> states_of(const ResponseCurve& curve,
                                                   const PreparedRecord& record) {
  std::vector<std::vector<PeriodicMotion>> states = curve.at(angular_frequencies(record));
  for (std::vector<PeriodicMotion>& at_line : states) {
    if (at_line.empty()) return {};
    at_line = stable(at_line);
  }
  return states;
}

std::optional<double> last_of_several(const PreparedRecord& record,
                                      const std::vector<std::vector<PeriodicMotion>>& states) {
  const std::vector<std::size_t> order = sweep_order(record);
  if (states.empty() || states[order.back()].size() > 1) return std::nullopt;
  std::optional<double> out;
  for (const std::size_t b : order)
    if (states[b].size() > 1) out = record.sines.frequency_hz[b];
  return out;
}

/// The squares of what each state's magnitude misses; zero where there is no choice.
Costs costs_of(const HarmonicBalance& balance, const PreparedRecord& record,
               const std::vector<std::size_t>& order,
               const std::vector<std::vector<PeriodicMotion>>& states) {
  std::vector<PeriodicMotion> several;
  for (const std::size_t b : order)
    if (states[b].size() > 1) several.insert(several.end(), states[b].begin(), states[b].end());
  const std::vector<Complex> readings = readings_at(balance, several);
  Costs costs;
  auto next = readings.begin();
  for (const std::size_t b : order) {
    std::vector<double>& cost = costs.emplace_back(states[b].size(), 0.);
    if (cost.size() == 1) continue;
    for (double& value : cost)
      value =
          std::pow(record.sines.per_amplitude * std::abs(*next++) - std::abs(record.moment[b]), 2);
  }
  return costs;
}

/// The states of the sweep by line.
std::vector<PeriodicMotion> swept(const ResponseCurve& curve, const PreparedRecord& record,
                                  std::vector<std::vector<PeriodicMotion>> states) {
  if (states.empty()) return {};
  const std::vector<std::size_t> order = sweep_order(record);
  hold_ended_branches(record.sines.frequency_hz, order, states);
  const std::vector<std::size_t> choice =
      cheapest_rising(costs_of(curve.balance(), record, order, states));
  std::vector<PeriodicMotion> out(states.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = states[order[i]][choice[i]];
  return out;
}

/// Readings in proportion to the drive, as far as the chain's laws are left out.
std::vector<Complex> linear_readings(const Chain& chain, const PreparedRecord& record) {
  const LinearResponse response(chain);
  const std::vector<double> level = levels(record);
  std::vector<Complex> out;
  for (std::size_t b = 0; b < level.size(); ++b) {
    const LinearPart part = response.at(record.line_s(b + 1), record.readout, record.magnet);
    out.push_back(part.base * part.sensor * level[b]);
  }
  return out;
}

}  // namespace

bool is_nonlinear_sweep(const Chain& chain, const PreparedRecord& record) {
  return record.is_response() && record.magnet && !chain.structure.modes.empty() &&
         (!chain.joint.empty() || !chain.readout.empty());
}

SweepStates::SweepStates(const Chain& chain, const PreparedRecord& record) : chain_(chain) {
  const ResponseCurve curve = curve_of(chain, record);
  std::vector<std::vector<PeriodicMotion>> states = states_of(curve, record);
  branch_end_hz_ = last_of_several(record, states);
  motions_ = swept(curve, record, std::move(states));
  if (motions_.empty()) {
    readings_ = linear_readings(chain, record);
    return;
  }
  highest_order_ = curve.balance().basis().highest();
  readings_ = readings_at(curve.balance(), motions_);
}

const std::vector<SweepStates::Linearisation>& SweepStates::linearised(
    const PreparedRecord& record) const {
  std::call_once(is_linearised_, [&] {
    const HarmonicBalance balance(chain_, drive_of(record), highest_order_);
    for (std::size_t b = 0; b < motions_.size(); ++b) {
      const HarmonicBalance::Linearised at = balance.linearised(motions_[b]);
      const bool is_held = motions_[b].w_rad_s != record.line_s(b + 1).imag();
      linearised_.push_back({at.error, at.by_coordinates.inverse() * (is_held ? 0. : 1.)});
    }
  });
  return linearised_;
}

std::vector<Complex> SweepStates::readings_of(const Chain& changed,
                                              const PreparedRecord& record) const {
  if (motions_.empty()) return linear_readings(changed, record);
  const std::vector<Linearisation>& here = linearised(record);
  const HarmonicBalance balance(changed, drive_of(record), highest_order_);
  std::vector<PeriodicMotion> motions = motions_;
  for (std::size_t first = 0; first < motions.size(); first += n_lanes) {
    const auto some = std::span(motions).subspan(first, std::min(n_lanes, motions.size() - first));
    const std::vector<Eigen::VectorXd> errors = balance.errors(some);
    for (std::size_t i = 0; i < some.size(); ++i)
      some[i].y -= here[first + i].inverse * (errors[i] - here[first + i].error);
  }
  return readings_at(balance, motions);
}

}  // namespace vibrissa::diagnosis
