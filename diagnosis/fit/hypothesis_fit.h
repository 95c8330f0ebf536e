#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/fit/fit_posterior.h"
#include "diagnosis/fit/goodness_of_fit.h"
#include "diagnosis/fit/optimiser.h"
#include "diagnosis/model/hypothesis.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Nuisances that are said to differ from nominal, by anything their range allows. Half of all
/// sensors are as simulated in the others, half are a little off in all of them, as built.
struct CalibrationChoice {
  std::vector<std::string> named{};  // ids, alphabetical
  double log_evidence = 0.;          // of the data
};

/// Power that the form errors of effects and calibrations may have, around each bin [(N m)^2].
struct FormErrors {
  std::vector<double> linear, nonlinear;
};

/// What a fit predicts of one record, bins as PreparedRecord::moment.
struct FittedRecord {
  std::vector<Complex> mean;
  std::vector<double> process_noise, variance;  // (N m)^2, of the effects alone and of all
  std::vector<RecordNuisance> unknowns{};       // Prediction::unknowns
  FormErrors model_form_errors;
};

/// A hypothesis at its most probable parameters. Parameters in their coordinates x.
struct HypothesisFit {
  Hypothesis hypothesis;
  bool as_simulated = false;  // but for the effects: see fit_as_simulated()
  std::vector<FitParameter> fit_parameters;
  Eigen::VectorXd x;
  Eigen::MatrixXd information;  // Fisher's, with the priors' curvature
  Eigen::MatrixXd covariance;   // its inverse
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double log_posterior = -std::numeric_limits<double>::infinity();  // density at x
  double log_evidence = -std::numeric_limits<double>::infinity();   // all nuisances free
  std::vector<CalibrationChoice> choices;                           // best first
  int n_iterations = 0;
  /// Whitened energy of what each effect or calibration does, sum |mean - mean without it|^2 / S.
  std::vector<std::pair<const Effect*, double>> effect_energy;
  std::vector<FittedRecord> records;
  GoodnessOfFit goodness;

  /// Form errors of all effects and calibrations but one, in whitened energy: what gains less than
  /// this is not told from them.
  double form_energy(const Effect* but = nullptr) const;
  /// Variance of a shift of a calibration that moves the prediction no more than the others' form
  /// errors: it may stem from them. information: of the data, by the calibration.
  double shift_by_forms(const Effect* calibration, double information) const;
  /// Value and standard deviation of an effect's parameter (of x).
  std::optional<std::size_t> index(const std::string& effect, std::size_t parameter) const;
  Chain chain(const Experiment& experiment) const;
};

/// An effect at values that the residual of a fit without it resembles.
struct FurtherStart {
  const HypothesisFit* without = nullptr;
  const Effect* effect = nullptr;
  std::vector<double> values{};
};

/// Maximum posterior fit to all records of the experiment by Fisher scoring: DFT bins are
/// independent complex Gaussians of the chain's mean and variance (Whittle 1953),
///   log p = - sum |M - mean|^2 / S + log S,
///   S = n sigma_M^2 + n |G|^2 w sigma_a^2 + own noise + (misfit of the nominal form) + (form error
///   of the effects),
/// evidence by Laplace. start: coordinates to begin with beside the effects' own starts; further:
/// to begin with as well.
HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start = nullptr, const FitOptions& options = {},
                             const std::optional<FurtherStart>& further = std::nullopt);

/// The same with calibrations that are as simulated, no further off than the simulation and the
/// effects' forms are known: where free ones take up what an effect does as well, the half of all
/// sensors that are as simulated is not seen from there. free: that fit. Its one choice names no
/// calibration. Proven by tests/diagnosis/fit/fit_as_simulated_test.cc.
HypothesisFit fit_as_simulated(const Experiment& experiment, const HypothesisFit& free,
                               const FitOptions& options = {});

/// All records in turn, without the most probable course of what is unknown of each.
std::vector<WhitenedRecord> whitened_residual(const Experiment& experiment,
                                              const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
