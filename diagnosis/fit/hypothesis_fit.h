#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/fit/fit_posterior.h"
#include "diagnosis/fit/optimiser.h"
#include "diagnosis/model/hypothesis.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Prediction of one record by a fit; bins as in PreparedRecord::moment.
struct FittedRecord {
  std::vector<Complex> mean;
  std::vector<double> process_noise, variance;  // (N m)^2: of the effects, and total of the noise
  std::vector<RecordNuisance> unknowns{};       // as Prediction::unknowns
  std::vector<Complex> discrepancy{};           // its posterior mean [N m]
  std::vector<double> noise{};  // variance by the measured noise of both channels [(N m)^2]
};

/// A hypothesis at its most probable parameters, in their coordinates x.
struct HypothesisFit {
  Hypothesis hypothesis;
  std::vector<FitParameter> fit_parameters;
  Eigen::VectorXd x;
  Eigen::MatrixXd information;  // Fisher information plus the curvature of the priors
  Eigen::MatrixXd covariance;   // its inverse
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double log_posterior = -std::numeric_limits<double>::infinity();  // density at x
  double log_evidence = -std::numeric_limits<double>::infinity();
  int n_iterations = 0;
  std::vector<FittedRecord> records;
  /// 95 % intervals of the first parameters of calibration effects, in their coordinates, where
  /// other calibrations may move in their place.
  std::map<std::string, std::array<double, 2>> calibration_intervals{};

  /// Index of an effect's parameter among the fit's parameters.
  std::optional<std::size_t> index(const std::string& effect, std::size_t parameter) const;
  /// The effects and calibration parameters of the fit, each once, in the order of its parameters.
  std::vector<const Effect*> changes() const;
  /// The calibration effects that the fit held at their nominal values.
  std::vector<std::string> nominal_calibrations() const;
  Chain chain(const Experiment& experiment) const;
};

/// An effect at the values that match the residual of a fit without it.
struct FurtherStart {
  const HypothesisFit* without = nullptr;
  const Effect* effect = nullptr;
  std::vector<double> values{};
};

/// Maximum posterior fit to all records of the experiment by Fisher scoring: DFT bins are complex
/// Gaussians of the chain's mean (Whittle 1953), with independent noise of variance
///   S = n sigma_M^2 + n |G|^2 w sigma_a^2 + (process noise) + (misfit of the nominal model)
/// and the simulation's discrepancy (model_discrepancy.h); evidence by Laplace's approximation.
/// Calibration parameters are free in every hypothesis. start: starting coordinates in addition to
/// the effects' own starts; further: further starting values.
HypothesisFit fit_hypothesis(const Experiment& experiment, const Hypothesis& hypothesis,
                             const HypothesisFit* start = nullptr, const FitOptions& options = {},
                             const std::optional<FurtherStart>& further = std::nullopt);

/// Is a calibration parameter of the fit outside its tolerance?
bool has_recalibrated(const HypothesisFit& fit);

/// The nominal model with fitted noise alone, linearised with free calibration parameters: what the
/// gap looks like before they absorb a part of it.
HypothesisFit fit_as_simulated(const Experiment& experiment);

/// Power of the error that a fit leaves in a record above its noise, relative to the moment; and
/// the largest one of the records with motion (but one).
double error_left(const PreparedRecord& record, const FittedRecord& fitted);
double largest_error_left(const Experiment& experiment, const HypothesisFit& fit,
                          std::optional<std::size_t> but_one = std::nullopt);

/// Whitened residuals of all records, without the most probable discrepancy and per-record nuisance
/// parameters.
std::vector<WhitenedRecord> whitened_residual(const Experiment& experiment,
                                              const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
