#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Places among the figures of the ratios of a fit's retunes, but for the given ones.
std::vector<Eigen::Index> retunes_but(const HypothesisFit& fit,
                                      const std::vector<std::string>& ids);

/// A fit's figures when what is named of its retunes may lie anywhere in its range, in place of its
/// tolerance. Where retunes do the same, as gains do, tolerances share between them what one of
/// them did; once it is named it does all of it.
struct RetunedPosterior {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  double log_evidence = 0.;
};
/// In Gaussian approximation, ranges as normal distributions of the same spread. named: places of
/// ratios among the figures.
RetunedPosterior retuned_posterior(const HypothesisFit& fit,
                                   const std::vector<Eigen::Index>& named);

/// Log of what a retune's density gains over one that is even in its range, [-top, top], where half
/// of what is off is so by any order of magnitude: even in ln |x| from a thousandth of top up. x
/// from nominal, and its variance: what is not told from nominal has the density of its deviation.
/// An effect whose strength goes by its logarithm would be likelier than a small retune that does
/// the same, for that alone. Proven by tests/diagnosis/fit/calibration_choices_test.cc.
double log_any_magnitude(double top, double x, double variance);

/// Evidence of every set of nuisances that may differ from nominal, the others nominal, best first:
/// by Savage's and Dickey's ratio from the posterior with all of them free. A shift within what the
/// nominal form misses of the simulation, or within what form errors of the effects may bring,
/// counts as nominal. That nothing is named and all is as simulated is left to fit_as_simulated().
std::vector<RetuneChoice> retune_choices(const NominalModel& nominal, const HypothesisFit& fit);
/// The one choice of such a fit.
RetuneChoice as_simulated_choice(const HypothesisFit& fit);

/// A retune within this of nominal is nominal: the simulation is not known better than its form
/// follows its own records.
double negligible_retune(const NominalModel& nominal, const std::string& id);

}  // namespace vibrissa::diagnosis
