#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "diagnosis/checks/data_checks.h"
#include "diagnosis/localisation/location.h"
#include "diagnosis/planning/next_experiment.h"
#include "diagnosis/search/search.h"
#include "diagnosis/unknown/unknown_cause.h"
#include "diagnosis/validation/attribution.h"
#include "diagnosis/validation/comparison.h"
#include "diagnosis/validation/held_out.h"
#include "diagnosis/validation/level_comparison.h"
#include "diagnosis/validation/named_answers.h"

namespace vibrissa::diagnosis {

/// There are too few data for a diagnosis; the message says what is missing. Programs end with exit
/// status 3.
class TooLittleData : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct RankedAnswer {
  std::string name{};
  double probability = 0.;
  std::vector<ParameterEstimate> parameters{};
  /// Stiffness and mass as parameters of the finite-element model (parameter_estimates.h).
  std::vector<ParameterEstimate> materials{};
  std::optional<HeldOutScore> held_out{};  // for the first few answers
};

struct Gap {
  double nrmse = 0.;  // prediction error of the nominal model on held-out records (on fit records
                      // when there are none)
  double noise_floor = 0.;
  double p_value = 1.;
};

struct Diagnosis {
  Gap gap{};
  /// Of the best answer, on held-out records (on fit records when there are none).
  Attribution attribution{};
  Location location{};
  std::string verdict = "none";
  std::vector<RankedAnswer> ranking{};  // most probable first
  double probability_of_unlisted = 0.;
  /// Probability that any tested answer is right, listed or not. The rest to 1 is not decided by
  /// these records or was not tested (calibrated_odds.h).
  double probability_of_tried = 1.;
  /// Probability of a cause that is not in the catalogue: outside_catalogue as tested, plus its
  /// share of the undecided rest (unknown_share()).
  double probability_of_outside = 0.;
  /// The nearest known answer, where the verdict is outside_catalogue.
  std::optional<RankedAnswer> nearest_known{};
  /// Smallest set of answers, outside_catalogue included, that holds 95 % of their total
  /// probability (confidence_set.h).
  std::vector<std::string> confidence_set{};
  std::vector<std::vector<std::string>> indistinguishable{};
  std::vector<UntestedEffect> untested{};
  NextExperiment next{};
  std::vector<Finding> findings{};
  std::vector<std::string> guesses{};  // made while the dataset was read
  /// Nominal model and best answer compared with the records.
  ResponseComparison response{};
  std::vector<LevelComparison> levels{};
  TraceComparison trace{};
  /// Terms that describe what no known effect explains, where the answer is outside_catalogue or
  /// leaves more than twice the simulation's accuracy and more than noise.
  std::optional<UnknownCause> unknown_cause{};
  /// The simulation with the effects of the best answer and all fitted calibration parameters.
  UpdatedModel updated{};
  /// Change of the resonance and of the response below it by these effects; nothing where no known
  /// effect explains the records.
  std::optional<ResonanceChange> resonance{};
  /// Error of the wind speed read from held-out records, before and after correction.
  std::optional<BeforeAfter> wind_speed_error_m_s{};
  /// Quality of the separated wind moment, where its true value is known.
  std::optional<BeforeAfter> separation_sdr_db{};
};

struct DiagnoseOptions {
  SearchOptions search{};
  double simulated_rate_hz = 0.;  // 0: the simulation has no sampling rate
  double simulation_accuracy = usual_simulation_accuracy;
  /// Experiments of the menu that the bench can make; empty: all.
  std::vector<std::string> possible_experiments = {};
};

/// Compares a simulation with records: noise, location of the gap, cause with its probability,
/// improvement, next experiment. Throws UserError for wrong data (spoils_everything() in
/// finding.h), TooLittleData when no fit record can be compared. Proven by
/// tests/diagnosis/diagnosis_test.cc.
Diagnosis diagnose(const UpdatedModel& simulation, const signals::Dataset& real,
                   const DiagnoseOptions& options = {});

/// The experiment's simulation with the effects and calibration parameters of a fit, as a model.
UpdatedModel updated_model(const Experiment& experiment, const HypothesisFit& fit);

/// Does the answer name parameter errors only, so that the simulation needs recalibration and no
/// new physics? False for "none" and "outside_catalogue".
bool is_recalibration(const std::string& answer);

/// What an answer that names effects means for the simulation, without a full stop: "The simulation
/// needs recalibration: set stiffness to 1.21 times the simulated value" or "The simulation lacks
/// backlash".
std::string consequence(const Diagnosis& diagnosis);

/// Terms that describe what no known effect explains, as a sentence without a full stop; empty
/// where there are none to describe.
std::string unknown_sentence(const Diagnosis& diagnosis);

/// The diagnosis as docs/records.md describes it, schema "vibrissa-diagnosis-2". Numbers that are
/// not finite become null. Proven by tests/diagnosis/diagnosis_json_test.cc.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// Lines of at most 100 characters, at most 24 lines for a terminal: entries that do not fit
/// completely are left out.
std::string verdict_text(const Diagnosis& diagnosis, std::size_t most_lines = 24);

}  // namespace vibrissa::diagnosis
