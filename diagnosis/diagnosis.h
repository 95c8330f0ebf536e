#pragma once

#include <array>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "diagnosis/checks/data_checks.h"
#include "diagnosis/localisation/location.h"
#include "diagnosis/planning/next_experiment.h"
#include "diagnosis/search/search.h"
#include "diagnosis/validation/comparison.h"
#include "diagnosis/validation/cross_validation.h"
#include "diagnosis/validation/held_out.h"
#include "diagnosis/validation/resonance_change.h"
#include "diagnosis/validation/separation_quality.h"
#include "diagnosis/validation/shares.h"
#include "diagnosis/validation/untested.h"
#include "diagnosis/validation/wind_speed_error.h"

namespace vibrissa::diagnosis {

/// The data are too poor to say anything; the message says what is missing. Programs end with exit
/// status 3.
class TooLittleData : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A parameter of a named effect with its 95 % interval, in its own unit.
struct ParameterEstimate {
  std::string effect{}, name{}, unit{};
  double value = 0.;
  std::array<double, 2> ci95{};
  bool at_limit = false;  // of what is tried: the interval tells nothing
};

struct RankedAnswer {
  std::string name{};
  double probability = 0.;
  std::vector<ParameterEstimate> parameters{};
  /// Of stiffness and mass in the finite-element model's own parameters (material_estimates.h).
  std::vector<ParameterEstimate> materials{};
  std::optional<HeldOutScore> held_out{};           // of the first few
  std::optional<ResidualExcess> residual_excess{};  // of the same
  std::vector<EffectShare> shares{};                // of the first, when it is a combination
};

struct Gap {
  double nrmse = 0.;  // nominal model, held-out records; fit records when there are none
  double noise_floor = 0.;
  double p_value = 1.;
};

struct Diagnosis {
  Gap gap{};
  Location location{};
  std::string verdict = "none";
  std::vector<RankedAnswer> ranking{};  // most probable first
  double probability_of_unlisted = 0.;
  /// Of any answer that was tried, listed or not; what is left to 1 is something that these records
  /// do not show, or that was not tried (calibration.h).
  double probability_of_tried = 1.;
  /// Of no known effect: outside_catalogue as it was tried, and its share of what is left
  /// (unknown_share()).
  double probability_of_outside = 0.;
  /// The known answer that comes nearest, where the verdict is outside_catalogue.
  std::optional<RankedAnswer> nearest_known{};
  /// Fewest answers, that no known effect is there among them, that have 95 % of what all of them
  /// have (confidence_set.h).
  std::vector<std::string> confidence_set{};
  std::vector<std::vector<std::string>> indistinguishable{};
  std::vector<UntestedEffect> untested{};
  NextExperiment next{};
  std::vector<Finding> findings{};
  std::vector<std::string> guesses{};  // of the dataset
  /// Nominal model and best answer beside the records.
  ResponseComparison response{};
  TraceComparison trace{};
  /// The simulation with the best answer's effects and every calibration as fitted.
  UpdatedModel updated{};
  /// What they do to the resonance and to the response below it; nothing where no known effect
  /// explains the records.
  std::optional<ResonanceChange> resonance{};
  /// What that does to the wind speed that is read from held-out records.
  std::optional<WindSpeedError> wind_speed{};
  /// And to the wind's moment, where its truth is known.
  std::optional<SeparationQuality> separation{};
};

struct DiagnoseOptions {
  SearchOptions search{};
  HeldOutOptions held_out{};
  std::size_t n_scored = 3;       // answers with a held-out score
  std::size_t n_ranked = 12;      // answers listed
  double simulated_rate_hz = 0.;  // 0: the simulation has none
  /// Experiments of the menu that the bench can do; empty: all.
  std::vector<std::string> possible_experiments = {};
};

/// Compares a simulation with records: noise, where, what, how far, how sure and what next. Throws
/// UserError for data that spoil everything (finding.h), TooLittleData when no fit record can be
/// compared.
/// Proven by tests/diagnosis/diagnosis_test.cc.
Diagnosis diagnose(const UpdatedModel& simulation, const signals::Dataset& real,
                   const DiagnoseOptions& options = {});

/// Value and 95 % interval of each parameter that an answer names, back from the coordinates of the
/// fit and within the parameter's bounds.
std::vector<ParameterEstimate> parameter_estimates(const HypothesisFit& fit,
                                                   const std::string& name);

/// The experiment's simulation with what a fit has added to it: its chain as a model to keep.
UpdatedModel updated_model(const Experiment& experiment, const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
