#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Indices among the parameters of the ratios of a fit's calibrations, but for the given ones.
std::vector<Eigen::Index> calibrations_but(const HypothesisFit& fit,
                                           const std::vector<std::string>& ids);

/// A fit's parameters when what is named of its calibrations may lie anywhere in its range, in
/// place of its tolerance. Where calibrations do the same, as gains do, tolerances share between
/// them what one of them did; once it is named it does all of it.
struct RecalibratedPosterior {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  double log_evidence = 0.;
};
/// In Gaussian approximation, ranges as normal distributions of the same spread. named: indices of
/// ratios among the parameters.
RecalibratedPosterior recalibrated_posterior(const HypothesisFit& fit,
                                             const std::vector<Eigen::Index>& named);

/// Log of what a calibration's density gains over one that is even in its range, [-top, top], where
/// half of what is off is so by any order of magnitude: even in ln |x| from a thousandth of top up.
/// x from nominal, and its variance: what is not told from nominal has the density of its
/// deviation. An effect whose strength goes by its logarithm would be likelier than a small
/// calibration that does the same, for that alone. Proven by
/// tests/diagnosis/fit/calibration_choices_test.cc.
double log_any_magnitude(double top, double x, double variance);

/// Evidence of every set of nuisances that may differ from nominal, the others nominal, best first:
/// by Savage's and Dickey's ratio from the posterior with all of them free. A shift within what the
/// nominal form misses of the simulation, or within what form errors of the effects may bring,
/// counts as nominal. That nothing is named and all is as simulated is left to fit_as_simulated().
std::vector<CalibrationChoice> calibration_choices(const NominalModel& nominal,
                                                   const HypothesisFit& fit);
/// The one choice of such a fit.
CalibrationChoice as_simulated_choice(const HypothesisFit& fit);

/// A calibration within this of nominal is nominal: the simulation is not known better than its
/// form follows its own records.
double negligible_calibration(const NominalModel& nominal, const std::string& id);

}  // namespace vibrissa::diagnosis
