#include "diagnosis/resonance_gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/hypothesis.h"
#include "diagnosis/resonance_effects.h"
#include "diagnosis/words.h"
#include "signals/error.h"
#include "signals/number_text.h"

namespace vibrissa::diagnosis {
namespace {

using Effects = std::vector<const ResonanceEffect*>;

/// A gap within this many deviations is none.
constexpr double agreeing = 2.;

void require(const bool good, const std::string& what, const double value,
             const std::string& rule) {
  if (!good) throw signals::UserError(what + " is " + signals::to_text(value) + ": " + rule);
}

void check(const ResonanceFigures& figures, const std::string& whose) {
  const double f = figures.frequency_hz, s = figures.relative_deviation;
  require(std::isfinite(f) && f > 0., whose + " frequency [Hz]", f, "give a positive number");
  require(s > 0. && s < 0.5, whose + " frequency's relative deviation", s,
          "give a share between 0 and 0.5");
  const double d = figures.damping_relative_deviation;
  require(d > 0. && d < 0.5, whose + " damping ratio's relative deviation", d,
          "give a share between 0 and 0.5");
  if (const auto& zeta = figures.damping_ratio)
    require(*zeta > 0. && *zeta < 1., whose + " damping ratio", *zeta,
            "give a number between 0 and 1, a share of critical damping");
}

double normal_density(const double x, const double deviation) {
  const double z = x / deviation;
  return std::exp(-0.5 * z * z) / (deviation * std::sqrt(2. * std::numbers::pi));
}

/// The question in numbers.
struct Gap {
  double log_ratio = 0., deviation = 0.;  // of (f / f0)^2
  double share = 1.;
  std::optional<double> simulated_damping{}, damping_change{};
  double damping_deviation = 0.;

  double squared_ratio() const { return std::exp(log_ratio); }
  bool frequencies_agree() const { return std::abs(log_ratio) <= agreeing * deviation; }
  bool dampings_agree() const {
    return !damping_change || std::abs(std::log(*damping_change)) <= agreeing * damping_deviation;
  }
  std::optional<double> damping_left(const ModeChange& change) const {
    if (!damping_change) return std::nullopt;
    return *damping_change / damping_ratio_factor(change, share, *simulated_damping);
  }
  double damping_density(const ModeChange& change) const {
    static const Prior prior = log_usual("ratio", "1", 0.3, 3., 0.03, 30., 1.).prior;
    const std::optional<double> left = damping_left(change);
    return left ? std::exp(prior.log_density(std::log(*left))) : 1.;
  }
};

Gap gap_of(const ResonanceFigures& simulated, const ResonanceFigures& measured,
           const ResonanceModel& model) {
  Gap gap{.log_ratio = 2. * std::log(measured.frequency_hz / simulated.frequency_hz),
          .deviation = 2. * std::hypot(measured.relative_deviation, simulated.relative_deviation),
          .share = model.joint_share};
  if (simulated.damping_ratio && measured.damping_ratio) {
    gap.simulated_damping = simulated.damping_ratio;
    gap.damping_change = *measured.damping_ratio / *simulated.damping_ratio;
    gap.damping_deviation =
        std::hypot(measured.damping_relative_deviation, simulated.damping_relative_deviation);
  }
  return gap;
}

/// A point on the line of solutions.
struct Solution {
  std::array<double, 2> values{};  // of the effects
  ModeChange change{};
  double density = 0.;  // along the line, for one of ln (f / f0)^2
  double prior = 0.;    // of the point itself, with the damper that is left
};

/// Points of a coordinate in the middle of equal cells that cover its prior.
struct Cells {
  double first, width;
  int n;
  double at(int i) const { return first + (i + 0.5) * width; }
};
Cells cells(const UsualPrior& prior, const int n) {
  // A Student prior beyond twelve scales holds a hundred-thousandth.
  constexpr double widest = 12.;
  double low = prior.lowest(), high = prior.highest();
  if (prior.usual.kind == Prior::Kind::student) {
    low = std::max(low, prior.usual.centre - widest * prior.usual.scale);
    high = std::min(high, prior.usual.centre + widest * prior.usual.scale);
  }
  return {low, (high - low) / n, n};
}

/// The last effect's value on top of the others', with the density of meeting a ratio there.
std::optional<Solution> solved(const Effects& effects, const Gap& gap, const double log_ratio,
                               Solution point) {
  const ResonanceEffect& last = *effects.back();
  const auto value = last.solve(point.change, std::exp(log_ratio), gap.share);
  if (!value || (last.parameter.logarithmic && *value <= 0.)) return std::nullopt;
  const double x = last.parameter.coordinate(*value);
  const double density = last.prior.density(x);
  if (!(density > 0.)) return std::nullopt;
  const auto reached = [&](double shifted) {
    ModeChange change = point.change;
    last.apply(last.parameter.value(shifted), change);
    return std::log(squared_frequency_ratio(change, gap.share));
  };
  constexpr double step = 1e-5;
  const double slope = std::abs(reached(x + step) - reached(x - step)) / (2. * step);
  last.apply(*value, point.change);
  point.values[effects.size() - 1] = *value;
  const double here = density * gap.damping_density(point.change);
  point.prior *= here;
  point.density *= here / slope;
  return point;
}

/// Calls visit for every cell of the effects but the last; points carry density times cell.
template <typename Visit>
void for_each_start(const Effects& effects, const Visit& visit) {
  // A mount's mass ratio, a second figure, smooths what the cells sample.
  constexpr int n_masses = 24;
  int n_cells = 600;
  std::vector<Solution> points{{.density = 1., .prior = 1.}};
  const auto mount = std::find_if(effects.begin(), effects.end(), [](const ResonanceEffect* e) {
    return e->mass_ratio.has_value();
  });
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

/// Density that the effects give the measured figures.
double evidence(const Effects& effects, const Gap& gap) {
  constexpr int n = 21;
  constexpr double step = 8. / (n - 1);  // in deviations
  double sum = 0.;
  for_each_start(effects, [&](const Solution& start) {
    for (int i = 0; i < n; ++i) {
      const double z = -4. + i * step;
      if (const auto point = solved(effects, gap, gap.log_ratio + z * gap.deviation, start))
        sum += point->density * normal_density(z, 1.) * step;
    }
  });
  return sum;
}

/// Of the line of solutions at the measured figures.
std::optional<Solution> most_probable(const Effects& effects, const Gap& gap) {
  std::optional<Solution> best;
  for_each_start(effects, [&](const Solution& start) {
    const auto point = solved(effects, gap, gap.log_ratio, start);
    if (point && (!best || point->prior > best->prior)) best = point;
  });
  return best;
}

NeededValue needed(const ResonanceEffect& effect, const double value) {
  return {.effect = effect.effect->id,
          .name = effect.parameter.name,
          .unit = effect.parameter.unit,
          .value = value,
          .usual_low = effect.usual_low,
          .usual_high = effect.usual_high,
          .inside = value >= effect.usual_low && value <= effect.usual_high};
}

/// Values that one effect takes at the ends of what the figures may be.
std::optional<std::array<double, 2>> interval(const ResonanceEffect& effect, const Gap& gap) {
  const auto at = [&](double z) {
    return effect.solve({}, std::exp(gap.log_ratio + z * gap.deviation), gap.share);
  };
  const auto low = at(-1.96), high = at(1.96);
  if (!low || !high) return std::nullopt;
  return std::array<double, 2>{std::min(*low, *high), std::max(*low, *high)};
}

/// The modal ratio goes with that of the silicone, which only holds a part of the compliance.
NeededValue modal_stiffness(const double silicone_ratio, const double share) {
  const double ratio = 1. / (share / silicone_ratio + 1. - share);
  return {.effect = "stiffness",
          .name = "ratio",
          .unit = "1",
          .value = ratio,
          .usual_low = 0.3,
          .usual_high = 1.5,
          .inside = ratio >= 0.3 && ratio <= 1.5};
}

/// What the modulus would be if the share of the silicone were a deviation less or more.
std::string share_note(const ResonanceModel& model, const double modal_ratio) {
  std::string text = "modulus x ";
  for (const double side : {-1., 1.}) {
    const double share =
        std::clamp(model.joint_share + side * model.joint_share_deviation, 0.05, 1.);
    const double rest = 1. / modal_ratio - 1. + share;
    text += (rest > 0. ? three_digits(share / rest) : std::string("never")) +
            (side < 0. ? " for a silicone share " : " for ") + three_digits(share) +
            (side < 0. ? ", " : "");
  }
  if (model.silicone_modulus_pa)
    text += ", simulated with " + three_digits(1e-6 * *model.silicone_modulus_pa) + " MPa";
  return text;
}

std::string note_of(const Effects& effects, const ResonanceExplanation& explanation) {
  std::vector<std::string> notes;
  for (const NeededValue& value : explanation.parameters)
    if (!value.inside)
      notes.push_back(value.name + " outside its usual " + three_digits(value.usual_low) + " .. " +
                      three_digits(value.usual_high));
  for (const ResonanceEffect* effect : effects) notes.push_back(effect->remark);
  return joined(notes, "; ");
}

double log_prior(const Effects& effects, const std::size_t n_known) {
  double sum = log_prior_of_number(effects.size(), n_known);
  for (const ResonanceEffect* effect : effects) sum += effect->effect->log_prior;
  return sum;
}

/// Value of a single effect by its equation alone, though its prior excludes it.
std::optional<Solution> by_equation(const ResonanceEffect& effect, const Gap& gap) {
  Solution point;
  if (effect.mass_ratio) point.change.mount_mass = effect.mass_ratio->prior.high;
  const auto value = effect.solve(point.change, gap.squared_ratio(), gap.share);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  if (effect.parameter.logarithmic && *value <= 0.) return std::nullopt;
  point.values.front() = *value;
  effect.apply(*value, point.change);
  return point;
}

ResonanceExplanation explain(const Effects& effects, const Gap& gap, const ResonanceModel& model,
                             const std::size_t n_known) {
  ResonanceExplanation out;
  for (const ResonanceEffect* effect : effects) out.effects.push_back(effect->effect->id);
  out.odds = evidence(effects, gap) * std::exp(log_prior(effects, n_known));
  std::optional<Solution> point = most_probable(effects, gap);
  if (!point && effects.size() == 1) point = by_equation(*effects.front(), gap);
  out.possible = point.has_value();
  if (!point) {
    out.note = "no value brings the resonance there; " + effects.front()->remark;
    return out;
  }
  for (std::size_t i = 0; i < effects.size(); ++i) {
    NeededValue value = needed(*effects[i], point->values[i]);
    if (effects.size() == 1 && !effects[i]->mass_ratio) value.ci95 = interval(*effects[i], gap);
    if (value.effect == "stiffness")
      out.parameters.push_back(modal_stiffness(value.value, gap.share));
    out.parameters.push_back(std::move(value));
    if (const auto& mass = effects[i]->mass_ratio)
      out.parameters.push_back({.effect = effects[i]->effect->id,
                                .name = mass->name,
                                .unit = mass->unit,
                                .value = point->change.mount_mass,
                                .usual_low = mass->prior.low,
                                .usual_high = mass->prior.high,
                                .inside = true});
  }
  out.inside_usual_range = std::all_of(out.parameters.begin(), out.parameters.end(),
                                       [](const NeededValue& value) { return value.inside; });
  out.damping_left = gap.damping_left(point->change);
  out.note = note_of(effects, out);
  if (effects.size() == 1 && out.effects.front() == "stiffness")
    out.note = share_note(model, gap.squared_ratio()) + "; " + out.note;
  return out;
}

/// No effect at all, or only another damper.
ResonanceExplanation without_effects(const Gap& gap, const std::size_t n_known) {
  ResonanceExplanation out{.inside_usual_range = true, .note = "the frequencies agree"};
  out.odds = normal_density(gap.log_ratio, gap.deviation) * gap.damping_density({}) *
             std::exp(log_prior_of_number(0, n_known));
  out.damping_left = gap.damping_change;
  if (!gap.dampings_agree()) {
    out.effects = {"damping"};
    out.parameters = {{.effect = "damping",
                       .name = "ratio",
                       .unit = "1",
                       .value = *gap.damping_change,
                       .usual_low = 0.3,
                       .usual_high = 3.}};
    NeededValue& ratio = out.parameters.front();
    ratio.inside = ratio.value >= ratio.usual_low && ratio.value <= ratio.usual_high;
    out.inside_usual_range = ratio.inside;
  }
  if (!gap.frequencies_agree()) out.note = "the frequencies differ by more than their deviation";
  return out;
}

/// Something unknown: a factor of two in the frequency as soon as a per cent.
ResonanceExplanation unknown(const Gap& gap) {
  const Prior prior{.kind = Prior::Kind::student, .scale = std::log(2.)};
  return {.effects = {outside_catalogue},
          .odds = std::exp(log_prior_of_outside_catalogue + prior.log_density(gap.log_ratio)) *
                  gap.damping_density({}),
          .note = "nothing that the catalogue knows"};
}

void normalise(std::vector<ResonanceExplanation>& explanations) {
  double sum = 0.;
  for (const ResonanceExplanation& e : explanations) sum += e.odds;
  for (ResonanceExplanation& e : explanations) e.odds /= sum;
  std::stable_sort(explanations.begin(), explanations.end(),
                   [](const auto& a, const auto& b) { return a.odds > b.odds; });
}

std::vector<ResonanceExplanation> all_explanations(const Gap& gap,
                                                   const ResonanceFigures& simulated,
                                                   const ResonanceModel& model) {
  const std::vector<ResonanceEffect> known =
      resonance_effects(simulated.frequency_hz, model.silicone_modulus_pa);
  std::vector<ResonanceExplanation> out{without_effects(gap, known.size()), unknown(gap)};
  for (std::size_t i = 0; i < known.size(); ++i) {
    out.push_back(explain({&known[i]}, gap, model, known.size()));
    for (std::size_t j = 0; j < i; ++j) {
      // A mount is not solved for: its mass and its frequency both run.
      const bool mount_last = known[i].part == ResonanceEffect::Part::mount;
      const Effects pair =
          mount_last ? Effects{&known[i], &known[j]} : Effects{&known[j], &known[i]};
      ResonanceExplanation both = explain(pair, gap, model, known.size());
      if (both.possible) out.push_back(std::move(both));
    }
  }
  normalise(out);
  return out;
}

std::vector<std::string> confidence_set(const std::vector<ResonanceExplanation>& explanations) {
  std::vector<std::string> names;
  double sum = 0.;
  for (const ResonanceExplanation& e : explanations) {
    if (sum >= 0.95) break;
    names.push_back(e.name());
    sum += e.odds;
  }
  return names;
}

}  // namespace

std::string ResonanceExplanation::name() const {
  return joined_name(effects);
}

ResonanceDiagnosis explain_resonance_gap(const ResonanceFigures& simulated,
                                         const ResonanceFigures& measured,
                                         const ResonanceModel& model) {
  check(simulated, "the simulated");
  check(measured, "the measured");
  require(model.joint_share > 0. && model.joint_share <= 1.,
          "the silicone's share of the compliance", model.joint_share,
          "give a share above 0, at most 1");
  const Gap gap = gap_of(simulated, measured, model);
  ResonanceDiagnosis out{.simulated = simulated,
                         .measured = measured,
                         .model = model,
                         .modal_ratio = gap.squared_ratio(),
                         .explanations = all_explanations(gap, simulated, model)};
  out.verdict = out.explanations.front().name();
  out.confidence_set = confidence_set(out.explanations);
  std::vector<Candidate> candidates;
  for (const ResonanceExplanation& e : out.explanations)
    candidates.push_back({.name = e.name(), .retunes = {}, .probability = e.odds});
  out.next = next_experiment(candidates, out.confidence_set, {});
  return out;
}

ResonanceExample paper_gap() {
  return {
      .simulated = {.frequency_hz = 37.32, .damping_ratio = 0.05},
      .measured = {.frequency_hz = 31.47, .damping_ratio = 0.027},
      .model = {.joint_share = 0.71, .joint_share_deviation = 0.15, .silicone_modulus_pa = 2.04e6}};
}

}  // namespace vibrissa::diagnosis
