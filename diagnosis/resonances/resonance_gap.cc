#include "diagnosis/resonances/resonance_gap.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numbers>

#include "diagnosis/model/hypothesis.h"
#include "diagnosis/model/words.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/resonances/resonance_effects.h"
#include "diagnosis/search/confidence_set.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/student.h"

namespace vibrissa::diagnosis {
namespace {

void require(const bool good, const std::string& what, const double value,
             const std::string& rule) {
  if (!good) throw signals::UserError(what + " is " + signals::to_text(value) + ": " + rule);
}

void check(const ResonanceData& data, const std::string& whose) {
  const double f = data.frequency_hz, s = data.relative_deviation;
  require(std::isfinite(f) && f > 0., whose + " frequency [Hz]", f, "give a positive number");
  require(s > 0. && s < 0.5, whose + " frequency's relative deviation", s,
          "give a value between 0 and 0.5");
  const double d = data.damping_relative_deviation;
  require(d > 0. && d < 0.5, whose + " damping ratio's relative deviation", d,
          "give a value between 0 and 0.5");
  if (const auto& zeta = data.damping_ratio)
    require(*zeta > 0. && *zeta < 1., whose + " damping ratio", *zeta,
            "give a value between 0 and 1 (ratio to critical damping)");
}

ResonanceGap gap_of(const ResonanceData& simulated, const ResonanceData& measured,
                    const ResonanceModel& model) {
  ResonanceGap gap{
      .log_ratio = 2. * std::log(measured.frequency_hz / simulated.frequency_hz),
      .deviation = 2. * std::hypot(measured.relative_deviation, simulated.relative_deviation),
      .joint_share = model.joint_share};
  if (simulated.damping_ratio && measured.damping_ratio) {
    gap.simulated_damping = simulated.damping_ratio;
    gap.damping_change = *measured.damping_ratio / *simulated.damping_ratio;
    gap.damping_deviation =
        std::hypot(measured.damping_relative_deviation, simulated.damping_relative_deviation);
  }
  return gap;
}

/// Values of one effect at the ends of the 95 % interval of the frequency ratio.
std::optional<std::array<double, 2>> interval(const ResonanceEffect& effect,
                                              const ResonanceGap& gap) {
  const auto at = [&](double z) {
    return effect.solve({}, std::exp(gap.log_ratio + z * gap.deviation), gap.joint_share);
  };
  const auto low = at(-signals::normal_quantile_975), high = at(signals::normal_quantile_975);
  if (!low || !high) return std::nullopt;
  return std::array<double, 2>{std::min(*low, *high), std::max(*low, *high)};
}

/// Modulus ratios for a silicone share of one standard deviation less and more.
std::string share_note(const ResonanceModel& model, const double modal_ratio) {
  std::string text = "modulus ";
  for (const double side : {-1., 1.}) {
    const double share =
        std::clamp(model.joint_share + side * model.joint_share_deviation, 0.05, 1.);
    const double rest = 1. / modal_ratio - 1. + share;
    text += (rest > 0. ? "x " + three_digits(share / rest) : std::string("impossible")) +
            (side < 0. ? " for a silicone share of the compliance of " : " for ") +
            three_digits(share) + (side < 0. ? ", " : "");
  }
  if (model.silicone_modulus_pa)
    text += ", simulated with " + three_digits(1e-6 * *model.silicone_modulus_pa) + " MPa";
  return text;
}

std::string note_of(const ResonanceEffects& effects, const ResonanceExplanation& explanation) {
  std::vector<std::string> notes;
  for (const NeededValue& value : explanation.parameters)
    if (!value.inside())
      notes.push_back(value.name + " outside its usual range " + three_digits(value.usual_low) +
                      " .. " + three_digits(value.usual_high));
  for (const ResonanceEffect* effect : effects) notes.push_back(effect->remark);
  return joined(notes, "; ");
}

double log_prior(const ResonanceEffects& effects, const std::size_t n_known) {
  double sum = log_prior_of_number(effects.size(), n_known);
  for (const ResonanceEffect* effect : effects) sum += effect->effect->log_prior;
  return sum;
}

/// Value of a single effect by its equation alone, even if its prior excludes it; for a mount, with
/// the largest mass ratio.
std::optional<Solution> by_equation(const ResonanceEffect& effect, const ResonanceGap& gap) {
  Solution point;
  if (effect.mass_ratio) point.change.mount_mass = effect.mass_ratio->prior.high;
  const auto value = effect.solve(point.change, gap.squared_ratio(), gap.joint_share);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  if (effect.parameter.logarithmic && *value <= 0.) return std::nullopt;
  point.values.front() = *value;
  effect.apply(*value, point.change);
  return point;
}

/// The reported solution: for a combination and for a mount the most probable one; for a mount
/// outside its usual range the one closest to that range.
std::optional<Solution> told_point(const ResonanceEffects& effects, const ResonanceGap& gap) {
  if (effects.size() > 1) return most_probable(effects, gap);
  const ResonanceEffect& effect = *effects.front();
  const std::optional<Solution> heaviest = by_equation(effect, gap);
  if (!effect.mass_ratio || !heaviest || heaviest->values.front() < effect.usual_low)
    return heaviest;
  return most_probable(effects, gap);
}

std::vector<NeededValue> needed_values(const ResonanceEffects& effects, const ResonanceGap& gap,
                                       const Solution& point) {
  std::vector<NeededValue> out;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const ResonanceEffect& effect = *effects[i];
    NeededValue value{.effect = effect.effect->id,
                      .name = effect.parameter.name,
                      .unit = effect.parameter.unit,
                      .value = point.values[i],
                      .usual_low = effect.usual_low,
                      .usual_high = effect.usual_high};
    if (effects.size() == 1 && !effect.mass_ratio) value.ci95 = interval(effect, gap);
    // The silicone holds only a part of the compliance.
    if (value.effect == "stiffness")
      out.push_back({.effect = value.effect,
                     .name = "ratio",
                     .unit = "1",
                     .value = squared_frequency_ratio({.joint = value.value}, gap.joint_share),
                     .usual_low = 0.3,
                     .usual_high = 1.5});
    out.push_back(std::move(value));
    if (const auto& mass = effect.mass_ratio)
      out.push_back({.effect = effect.effect->id,
                     .name = mass->name,
                     .unit = mass->unit,
                     .value = point.change.mount_mass,
                     .usual_low = mass->prior.low,
                     .usual_high = mass->prior.high});
  }
  return out;
}

ResonanceExplanation explain(const ResonanceEffects& effects, const ResonanceGap& gap,
                             const ResonanceModel& model, const std::size_t n_known) {
  ResonanceExplanation out;
  for (const ResonanceEffect* effect : effects) out.effects.push_back(effect->effect->id);
  out.odds = evidence(effects, gap) * std::exp(log_prior(effects, n_known));
  const std::optional<Solution> point = told_point(effects, gap);
  out.possible = point.has_value();
  if (!point) {
    out.note = "no value explains the measured resonance; " + effects.front()->remark;
    return out;
  }
  out.parameters = needed_values(effects, gap, *point);
  out.inside_usual_range = std::ranges::all_of(out.parameters, &NeededValue::inside);
  out.damping_left = gap.damping_left(point->change);
  out.note = note_of(effects, out);
  if (effects.size() == 1 && out.effects.front() == "stiffness")
    out.note = share_note(model, gap.squared_ratio()) + "; " + out.note;
  return out;
}

/// No effect at all, or only a change of damping.
ResonanceExplanation without_effects(const ResonanceGap& gap, const std::size_t n_known) {
  ResonanceExplanation out{.inside_usual_range = true, .note = "the frequencies agree"};
  out.odds = boost::math::pdf(boost::math::normal(0., gap.deviation), gap.log_ratio) *
             gap.damping_density({}) * std::exp(log_prior_of_number(0, n_known));
  out.damping_left = gap.damping_change;
  if (!gap.dampings_agree()) {
    out.effects = {"damping"};
    out.parameters = {{.effect = "damping",
                       .name = "ratio",
                       .unit = "1",
                       .value = *gap.damping_change,
                       .usual_low = 0.3,
                       .usual_high = 3.}};
    out.inside_usual_range = out.parameters.front().inside();
  }
  if (!gap.frequencies_agree()) out.note = "the frequencies differ by more than their deviation";
  return out;
}

/// An unknown cause, with a wide prior of the frequency change (scale: a factor of two).
ResonanceExplanation unknown(const ResonanceGap& gap) {
  const Prior prior{.kind = Prior::Kind::student, .scale = std::log(2.)};
  return {.effects = {outside_catalogue},
          .odds = std::exp(log_prior_of_outside_catalogue + prior.log_density(gap.log_ratio)) *
                  gap.damping_density({}),
          .note = "a cause that is not in the catalogue"};
}

std::vector<ResonanceExplanation> all_explanations(const ResonanceGap& gap,
                                                   const ResonanceData& simulated,
                                                   const ResonanceModel& model) {
  const std::vector<ResonanceEffect> known =
      resonance_effects(simulated.frequency_hz, model.silicone_modulus_pa);
  std::vector<ResonanceExplanation> out{without_effects(gap, known.size()), unknown(gap)};
  for (std::size_t i = 0; i < known.size(); ++i) {
    out.push_back(explain({&known[i]}, gap, model, known.size()));
    for (std::size_t j = 0; j < i; ++j) {
      // The equation is not solved for a mount, because its mass and its frequency both vary.
      const bool mount_last = known[i].part == ResonanceEffect::Part::mount;
      const ResonanceEffects pair = mount_last ? ResonanceEffects{&known[i], &known[j]}
                                               : ResonanceEffects{&known[j], &known[i]};
      ResonanceExplanation both = explain(pair, gap, model, known.size());
      if (both.possible) out.push_back(std::move(both));
    }
  }
  double sum = 0.;
  for (const ResonanceExplanation& e : out) sum += e.odds;
  for (ResonanceExplanation& e : out) e.odds /= sum;
  std::ranges::stable_sort(out, std::ranges::greater(), &ResonanceExplanation::odds);
  return out;
}

}  // namespace

ResonanceModel resonance_model_from(const signals::ReducedModel& model, const double simulated_hz) {
  constexpr double same_sensor = 0.1;
  const NominalModel nominal = nominal_from(model);
  const double hz = nominal.modes.front().frequency_rad_s / (2. * std::numbers::pi);
  if (!(std::abs(hz / simulated_hz - 1.) <= same_sensor))
    throw signals::UserError("model '" + model.name + "' has its first resonance at " +
                             three_digits(hz) + " Hz, but the simulated resonance is given as " +
                             three_digits(simulated_hz) + " Hz: give the model that belongs to it");
  ResonanceModel out{.joint_share = nominal.joint_share,
                     .joint_share_deviation = nominal.joint_share_deviation,
                     .silicone_modulus_pa = std::nullopt};
  for (const signals::Sensitivity& sensitivity : model.sensitivities)
    if (sensitivity.parameter == "silicone_modulus" && sensitivity.nominal_value > 0.)
      out.silicone_modulus_pa = sensitivity.nominal_value;
  return out;
}

std::string ResonanceExplanation::name() const {
  return joined_name(effects);
}

ResonanceDiagnosis explain_resonance_gap(const ResonanceData& simulated,
                                         const ResonanceData& measured,
                                         const ResonanceModel& model) {
  check(simulated, "the simulated");
  check(measured, "the measured");
  require(model.joint_share > 0. && model.joint_share <= 1.,
          "the silicone's share of the compliance", model.joint_share,
          "give a value above 0 and at most 1");
  const ResonanceGap gap = gap_of(simulated, measured, model);
  ResonanceDiagnosis out{.simulated = simulated,
                         .measured = measured,
                         .model = model,
                         .modal_ratio = gap.squared_ratio(),
                         .explanations = all_explanations(gap, simulated, model)};
  out.verdict = out.explanations.front().name();
  std::vector<Candidate> candidates;
  for (const ResonanceExplanation& e : out.explanations)
    candidates.push_back({.name = e.name(), .calibrations = {}, .probability = e.odds});
  out.confidence_set = confidence_set(candidates, 0.95);
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
