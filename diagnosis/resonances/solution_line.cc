#include "diagnosis/resonances/resonance_effects.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

/// Resonances within this many standard deviations agree.
constexpr double agreeing = 2.;

/// Points of a coordinate in the middle of equal cells that cover its prior.
struct Cells {
  double first, width;
  int n;
  double at(int i) const { return first + (i + 0.5) * width; }
};
Cells cells(const UsualPrior& prior, const int n) {
  // A Student prior has a hundred-thousandth of its probability beyond twelve scales.
  constexpr double widest = 12.;
  double low = prior.lowest(), high = prior.highest();
  if (prior.usual.kind == Prior::Kind::student) {
    low = std::max(low, prior.usual.centre - widest * prior.usual.scale);
    high = std::min(high, prior.usual.centre + widest * prior.usual.scale);
  }
  return {low, (high - low) / n, n};
}

/// The last effect's value, given those of the others, with the density of the frequency ratio
/// there.
std::optional<Solution> solved(const ResonanceEffects& effects, const ResonanceGap& gap,
                               const double log_ratio, Solution point) {
  const ResonanceEffect& last = *effects.back();
  const auto value = last.solve(point.change, std::exp(log_ratio), gap.joint_share);
  if (!value || (last.parameter.logarithmic && *value <= 0.)) return std::nullopt;
  const double x = last.parameter.coordinate(*value);
  const double density = last.prior.density(x);
  if (!(density > 0.)) return std::nullopt;
  const auto reached = [&](double shifted) {
    ModeChange change = point.change;
    last.apply(last.parameter.value(shifted), change);
    return std::log(squared_frequency_ratio(change, gap.joint_share));
  };
  // Where the effect no longer shifts the resonance there is no solution line.
  constexpr double step = 1e-5, least_slope = 1e-9;
  const double slope = std::abs(reached(x + step) - reached(x - step)) / (2. * step);
  if (!(slope > least_slope)) return std::nullopt;
  last.apply(*value, point.change);
  point.values[effects.size() - 1] = *value;
  const double here = density * gap.damping_density(point.change);
  point.prior *= here;
  point.density *= here / slope;
  return point;
}

/// Calls visit for every cell of the effects but the last; points carry density times cell.
template <typename Visit>
void for_each_start(const ResonanceEffects& effects, const Visit& visit) {
  // A mount's mass ratio, a second parameter, is integrated within each cell.
  constexpr int n_masses = 24;
  int n_cells = 600;
  std::vector<Solution> points{{.density = 1., .prior = 1.}};
  const auto mount = std::ranges::find_if(
      effects, [](const ResonanceEffect* effect) { return effect->mass_ratio.has_value(); });
  if (mount != effects.end()) {
    points.clear();
    n_cells = 150;
    const Prior& prior = (*mount)->mass_ratio->prior;
    for (int i = 0; i < n_masses; ++i)
      points.push_back(
          {.change = {.mount_mass = prior.low + (i + 0.5) / n_masses * (prior.high - prior.low)},
           .density = 1. / n_masses,
           .prior = 1.});
  }
  for (const Solution& start : points) {
    if (effects.size() == 1) {
      visit(start);
      continue;
    }
    const ResonanceEffect& first = *effects.front();
    const Cells grid = cells(first.prior, n_cells);
    for (int i = 0; i < grid.n; ++i) {
      Solution point = start;
      const double value = first.parameter.value(grid.at(i));
      point.prior *= first.prior.density(grid.at(i));
      if (!(point.prior > 0.)) continue;
      first.apply(value, point.change);
      point.values.front() = value;
      point.density *= first.prior.density(grid.at(i)) * grid.width;
      visit(point);
    }
  }
}

}  // namespace

bool ResonanceGap::frequencies_agree() const {
  return std::abs(log_ratio) <= agreeing * deviation;
}

bool ResonanceGap::dampings_agree() const {
  return !damping_change || std::abs(std::log(*damping_change)) <= agreeing * damping_deviation;
}

std::optional<double> ResonanceGap::damping_left(const ModeChange& change) const {
  if (!damping_change) return std::nullopt;
  return *damping_change / damping_ratio_factor(change, joint_share, *simulated_damping);
}

double ResonanceGap::damping_density(const ModeChange& change) const {
  static const Prior prior = log_usual("ratio", "1", 0.3, 3., 0.03, 30., 1.).prior;
  const std::optional<double> left = damping_left(change);
  return left ? std::exp(prior.log_density(std::log(*left))) : 1.;
}

double evidence(const ResonanceEffects& effects, const ResonanceGap& gap) {
  constexpr int n = 21;
  constexpr double step = 8. / (n - 1);  // in deviations
  double sum = 0.;
  for_each_start(effects, [&](const Solution& start) {
    for (int i = 0; i < n; ++i) {
      const double z = -4. + i * step;
      if (const auto point = solved(effects, gap, gap.log_ratio + z * gap.deviation, start))
        sum += point->density * boost::math::pdf(boost::math::normal(), z) * step;
    }
  });
  return sum;
}

std::optional<Solution> most_probable(const ResonanceEffects& effects, const ResonanceGap& gap) {
  std::optional<Solution> best;
  for_each_start(effects, [&](const Solution& start) {
    const auto point = solved(effects, gap, gap.log_ratio, start);
    if (point && (!best || point->prior > best->prior)) best = point;
  });
  return best;
}

}  // namespace vibrissa::diagnosis
