#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Indices of the ratios of a fit's calibration parameters, without the given ones.
std::vector<Eigen::Index> calibrations_but(const HypothesisFit& fit,
                                           const std::vector<std::string>& ids);

/// Posterior of a fit in which the named calibration parameters have their full range instead of
/// their tolerance. With tolerances, calibration parameters of the same influence (such as gains)
/// share a change; a named one takes all of it.
struct RecalibratedPosterior {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  double log_evidence = 0.;
};
/// Gaussian approximation, in which ranges are normal distributions of the same spread. named:
/// indices of ratios among the parameters.
RecalibratedPosterior recalibrated_posterior(const HypothesisFit& fit,
                                             const std::vector<Eigen::Index>& named);

/// Log ratio of a calibration parameter's prior density to the uniform density in [-top, top]. Half
/// of the prior is uniform in ln |x| from top / 1000 on. x: difference from nominal, with its
/// variance; a value not significantly different from nominal has the density at its standard
/// deviation. Without this an effect with a logarithmic prior would be more probable than a small
/// calibration error with the same influence. Proven by
/// tests/diagnosis/fit/calibration_choices_test.cc.
double log_any_magnitude(double top, double x, double variance);

/// Evidence of every set of nuisances that may differ from nominal while the others are nominal,
/// best first, by the Savage-Dickey density ratio from the posterior with all of them free. A shift
/// within the misfit of the nominal model, or within the model form errors of the effects, counts
/// as nominal. fit_as_simulated() covers the case that all are as simulated and none is named.
std::vector<CalibrationChoice> calibration_choices(const NominalModel& nominal,
                                                   const HypothesisFit& fit);
/// The only choice of a fit as simulated.
CalibrationChoice as_simulated_choice(const HypothesisFit& fit);

/// A calibration parameter within this distance of nominal counts as nominal, because the nominal
/// model follows the simulation only with this accuracy.
double negligible_calibration(const NominalModel& nominal, const std::string& id);

}  // namespace vibrissa::diagnosis
