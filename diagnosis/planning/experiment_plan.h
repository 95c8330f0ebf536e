#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/planning/effect_power.h"
#include "diagnosis/planning/next_experiment.h"
#include "diagnosis/planning/planned_records.h"

namespace vibrissa::diagnosis {

/// What one entry of experiment_menu() would add to the planned records.
struct PlannedStep {
  std::string name{};
  std::string what{};    // to do on the bench
  bool by_rule = false;  // not simulated: what the menu says of it, at best
  double duration_s = 0.;
  std::vector<std::string> finds{};  // effects found only with it, on either sensor
  std::vector<std::pair<std::string, std::string>> separates{};  // alphabetical within a pair
  /// Probability of an undecided answer that it takes away.
  double gain = 0.;
};

struct PlannedRecord {
  std::string name{}, excitation{};
  double duration_s = 0.;
};

/// What an experiment could say, before there are data.
struct ExperimentPlan {
  ChannelNoise noise{};
  std::vector<PlannedRecord> records{};
  std::vector<EffectPower> effects{};  // of the catalogue, by id
  double undecided = 1.;
  std::vector<PlannedStep> steps{};  // largest gain first
};

struct PlanOptions {
  std::size_t n_threads = 2;
  std::function<void()> on_effect = {};  // after each effect of each experiment, one at a time
};

/// Number of calls of on_effect.
std::size_t n_plan_steps(const NominalModel& nominal, const std::vector<PlannedInput>& inputs);

/// Detection limits, effects that are alike, and the gain of each entry of the menu: those that
/// records express are simulated beside the planned ones, the others follow the menu's table. Sizes
/// of effects stay those of the planned records. Throws UserError for noise that is not positive
/// and for inputs that the nominal model does not know. Proven by
/// tests/diagnosis/planning/experiment_plan_test.cc.
ExperimentPlan plan_experiments(const NominalModel& nominal,
                                const std::vector<PlannedInput>& inputs, const ChannelNoise& noise,
                                const PlanOptions& options = {});

/// Probability that one effect, drawn by the catalogue's prior at its typical strength, stays
/// unfound or is taken for one that is alike: of these, each is named by its prior. Half of all
/// sensors are exact otherwise, half as built.
double undecided_probability(const std::vector<EffectPower>& effects);

}  // namespace vibrissa::diagnosis
