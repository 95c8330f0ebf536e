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

/// Nuisances that are named as different from nominal, anywhere in their range. For the others,
/// half of all sensors are as simulated, and half deviate in all of them within building
/// tolerances.
struct CalibrationChoice {
  std::vector<std::string> named{};  // ids, alphabetical
  double log_evidence = 0.;          // evidence of the data
};

/// Power of the model form errors of effects and calibration parameters around each bin [(N m)^2].
struct FormErrors {
  std::vector<double> linear, nonlinear;
};

/// Prediction of one record by a fit; bins as in PreparedRecord::moment.
struct FittedRecord {
  std::vector<Complex> mean;
  std::vector<double> process_noise, variance;  // (N m)^2: of the effects, and total
  std::vector<RecordNuisance> unknowns{};       // as Prediction::unknowns
  FormErrors model_form_errors;
};

/// A hypothesis at its most probable parameters, in their coordinates x.
struct HypothesisFit {
  Hypothesis hypothesis;
  bool as_simulated = false;  // apart from the effects: see fit_as_simulated()
  std::vector<FitParameter> fit_parameters;
  Eigen::VectorXd x;
  Eigen::MatrixXd information;  // Fisher information plus the curvature of the priors
  Eigen::MatrixXd covariance;   // its inverse
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double log_posterior = -std::numeric_limits<double>::infinity();  // density at x
  double log_evidence = -std::numeric_limits<double>::infinity();   // with all nuisances free
  std::vector<CalibrationChoice> choices;                           // best first
  int n_iterations = 0;
  /// Whitened energy of each effect's or calibration parameter's influence, sum |mean - mean
  /// without it|^2 / S.
  std::vector<std::pair<const Effect*, double>> effect_energy;
  std::vector<FittedRecord> records;
  GoodnessOfFit goodness;

  /// Whitened energy of the model form errors of all effects and calibration parameters but one. An
  /// effect that gains less cannot be distinguished from them.
  double form_energy(const Effect* but = nullptr) const;
  /// Variance of a shift of a calibration parameter that the model form errors of the others may
  /// cause. information: Fisher information of the data on the calibration parameter.
  double shift_by_forms(const Effect* calibration, double information) const;
  /// Value and standard deviation of an effect's parameter (standard deviation in x).
  std::optional<std::size_t> index(const std::string& effect, std::size_t parameter) const;
  Chain chain(const Experiment& experiment) const;
};

/// An effect at the values that match the residual of a fit without it.
struct FurtherStart {
  const HypothesisFit* without = nullptr;
  const Effect* effect = nullptr;
  std::vector<double> values{};
};

/// Maximum posterior fit to all records of the experiment by Fisher scoring: DFT bins are
/// independent complex Gaussians of the chain's mean and variance (Whittle 1953),
///   log p = - sum |M - mean|^2 / S + log S,
///   S = n sigma_M^2 + n |G|^2 w sigma_a^2 + (process noise) + (misfit of the nominal model) +
///   (model form error of the effects),
/// evidence by Laplace's approximation. start: starting coordinates in addition to the effects' own
/// starts; further: further starting values.
HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start = nullptr, const FitOptions& options = {},
                             const std::optional<FurtherStart>& further = std::nullopt);

/// The same with calibration parameters as simulated, which deviate only within the accuracy of the
/// simulation and of the effects' forms. It represents the half of all sensors that are as
/// simulated, because free calibration parameters may absorb an effect. free: the fit with free
/// ones. Its only choice names no calibration parameter. Proven by
/// tests/diagnosis/fit/fit_as_simulated_test.cc.
HypothesisFit fit_as_simulated(const Experiment& experiment, const HypothesisFit& free,
                               const FitOptions& options = {});

/// Whitened residuals of all records, without the most probable values of the per-record nuisance
/// parameters.
std::vector<WhitenedRecord> whitened_residual(const Experiment& experiment,
                                              const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
