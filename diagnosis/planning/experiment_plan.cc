#include "diagnosis/planning/experiment_plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/planning/planned_records.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::diagnosis {
namespace {

using Pairs = std::set<std::pair<std::string, std::string>>;

Experiment prepared(const NominalModel& nominal, const std::vector<PlannedInput>& inputs,
                    const ChannelNoise& noise) {
  return prepare_experiment(nominal, planned_dataset(nominal, inputs, noise), signals::Split::fit,
                            InputNoise::reduced);
}

double duration_of(const std::vector<PlannedInput>& inputs) {
  double sum = 0.;
  for (const PlannedInput& input : inputs)
    sum += static_cast<double>(input.n_samples) / input.sampling_rate_hz;
  return sum;
}

Pairs alike_pairs(const std::vector<EffectPower>& effects, SensorKind kind) {
  Pairs out;
  for (const EffectPower& effect : effects)
    for (const std::string& alternative : effect.on(kind).alike)
      out.emplace(std::min(effect.effect, alternative), std::max(effect.effect, alternative));
  return out;
}

void set_gain(PlannedStep& step, const std::vector<EffectPower>& before,
              const std::vector<EffectPower>& after) {
  std::set<std::string> finds;
  Pairs separates;
  for (const SensorKind kind : sensor_kinds) {
    for (std::size_t i = 0; i < before.size(); ++i)
      if (after[i].on(kind).detected && !before[i].on(kind).detected) finds.insert(after[i].effect);
    const Pairs left = alike_pairs(after, kind);
    for (const auto& pair : alike_pairs(before, kind))
      if (left.count(pair) == 0) separates.insert(pair);
  }
  step.finds.assign(finds.begin(), finds.end());
  step.separates.assign(separates.begin(), separates.end());
  step.gain = undecided_probability(before) - undecided_probability(after);
}

/// The effects that remain alike when the bench sees all that the menu entry lists.
std::vector<EffectPower> by_table(const MenuEntry& entry, std::vector<EffectPower> effects) {
  const auto differs = [&](const std::string& a, const std::string& b) {
    const auto one = entry.shows.find(a), other = entry.shows.find(b);
    return one != entry.shows.end() && other != entry.shows.end() && one->second != other->second;
  };
  for (const SensorKind kind : sensor_kinds)
    for (EffectPower& effect : effects)
      std::erase_if(effect.on(kind).alike,
                    [&](const std::string& id) { return differs(effect.effect, id); });
  return effects;
}

void check_noise(const ChannelNoise& noise) {
  const auto refuse = [](double value, const std::string& name) {
    if (!std::isfinite(value) || value <= 0.)
      throw signals::UserError(name + " is " + signals::to_text(value) +
                               "; give the standard deviation per sample, a positive number");
  };
  refuse(noise.moment_n_m, "the noise of the moment");
  refuse(noise.acceleration_m_s2, "the noise of the acceleration");
}

}  // namespace

std::size_t n_plan_steps(const NominalModel& nominal, const std::vector<PlannedInput>& inputs) {
  std::size_t n = 1;
  for (const MenuEntry& entry : experiment_menu())
    if (added_inputs(entry.name, nominal, inputs)) ++n;
  return n * effect_catalogue().size();
}

ExperimentPlan plan_experiments(const NominalModel& nominal,
                                const std::vector<PlannedInput>& inputs, const ChannelNoise& noise,
                                PowerOptions options) {
  check_noise(noise);
  const Experiment experiment = prepared(nominal, inputs, noise);
  ExperimentPlan plan{.noise = noise};
  for (const PlannedInput& input : inputs)
    plan.records.push_back(
        {input.name,
         signals::to_string(signals::Excitation{!input.acceleration.empty(), !input.wind.empty()}),
         duration_of({input})});
  plan.effects = effect_powers(experiment, noise, options);
  plan.undecided = undecided_probability(plan.effects);
  options.limits = false;
  options.fewer_records = &plan.effects;
  const auto with_records = [&](const std::vector<PlannedInput>& added) {
    std::vector<PlannedInput> all = inputs;
    all.insert(all.end(), added.begin(), added.end());
    Experiment larger = prepared(nominal, all, noise);
    larger.scales = experiment.scales;
    return effect_powers(larger, noise, options);
  };
  for (const MenuEntry& entry : experiment_menu()) {
    const auto added = added_inputs(entry.name, nominal, inputs);
    PlannedStep step{.name = entry.name,
                     .what = entry.what,
                     .by_rule = !added.has_value(),
                     .duration_s = added ? duration_of(*added) : 0.};
    set_gain(step, plan.effects, added ? with_records(*added) : by_table(entry, plan.effects));
    plan.steps.push_back(std::move(step));
  }
  std::ranges::stable_sort(plan.steps, std::ranges::greater(), &PlannedStep::gain);
  return plan;
}

double undecided_probability(const std::vector<EffectPower>& effects) {
  const auto weight = [](const std::string& id) { return std::exp(find_effect(id).log_prior); };
  double undecided = 0., all = 0.;
  for (const SensorKind kind : sensor_kinds)
    for (const EffectPower& effect : effects) {
      const double own = weight(effect.effect);
      double alternatives = 0.;
      for (const std::string& alternative : effect.on(kind).alike)
        alternatives += weight(alternative);
      undecided += effect.on(kind).detected ? own * alternatives / (own + alternatives) : own;
      all += own;
    }
  return all > 0. ? undecided / all : 0.;
}

}  // namespace vibrissa::diagnosis
