#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/planning/effect_power.h"
#include "diagnosis/planning/next_experiment.h"
#include "diagnosis/planning/planned_records.h"

namespace vibrissa::diagnosis {

/// Information that one entry of experiment_menu() would add to the planned records.
struct PlannedStep {
  std::string name{};
  std::string what{};    // what to do on the bench
  bool by_rule = false;  // not simulated: upper estimate from the menu's table
  double duration_s = 0.;
  std::vector<std::string> finds{};  // effects detected only with it, on either kind of sensor
  std::vector<std::pair<std::string, std::string>> separates{};  // in alphabetical order
  /// Reduction of the probability of an undecided answer.
  double gain = 0.;
};

struct PlannedRecord {
  std::string name{}, excitation{};
  double duration_s = 0.;
};

/// What an experiment can detect and distinguish, before there are data.
struct ExperimentPlan {
  ChannelNoise noise{};
  std::vector<PlannedRecord> records{};
  std::vector<EffectPower> effects{};  // of the catalogue, sorted by id
  double undecided = 1.;
  std::vector<PlannedStep> steps{};  // largest gain first
};

/// Number of calls of on_effect in plan_experiments().
std::size_t n_plan_steps(const NominalModel& nominal, const std::vector<PlannedInput>& inputs);

/// Detection limits, indistinguishable effects, and the gain of each entry of the menu. Entries
/// that are records are simulated together with the planned ones; the others follow the menu's
/// table. on_effect is called after each effect of each experiment. Sizes of effects stay those of
/// the planned records. Throws UserError for noise that is not positive and for inputs that the
/// nominal model does not include. Proven by tests/diagnosis/planning/experiment_plan_test.cc.
ExperimentPlan plan_experiments(const NominalModel& nominal,
                                const std::vector<PlannedInput>& inputs, const ChannelNoise& noise,
                                PowerOptions options = {});

/// Schema "vibrissa-plan-1": assumed records and noise, effects with their detection limits and
/// indistinguishable alternatives, experiments of the menu. Numbers that are not finite become
/// null. Proven by tests/diagnosis/planning/experiment_plan_json_test.cc.
std::string plan_json(const ExperimentPlan& plan);

/// The plan as at most 20 lines of at most 100 characters for a terminal.
std::string plan_text(const ExperimentPlan& plan);

/// Probability that one effect, drawn from the catalogue's prior at its typical strength, stays
/// undetected or is mistaken for an indistinguishable one (each of these is named in proportion to
/// its prior). Half of all sensors are of the kind exact, half as_built.
double undecided_probability(const std::vector<EffectPower>& effects);

}  // namespace vibrissa::diagnosis
