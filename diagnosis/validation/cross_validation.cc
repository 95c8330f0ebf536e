#include "diagnosis/validation/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "diagnosis/fit/noise_levels.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/prediction/record_nuisances.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// The lowest bins, which contain drift that varies from day to day, are not used.
constexpr std::size_t first_bin = 4;

/// Factor on the power of process noise, because gusts and wakes vary from day to day.
constexpr double own_noise_margin = 1.5;

/// A fit's parameters with the measured noise levels and the full bounds of model form errors.
Eigen::VectorXd evaluation_parameters(const Experiment& experiment, const HypothesisFit& fit) {
  Eigen::VectorXd x = fit.x;
  const NoiseLevels levels = noise_levels(experiment, fit, fit.chain(experiment));
  x(static_cast<Eigen::Index>(index_of_moment_noise)) = 0.5 * std::log(levels.moment.variance);
  x(static_cast<Eigen::Index>(index_of_acceleration_noise)) =
      0.5 * std::log(levels.acceleration.variance);
  if (!fit.hypothesis.effects().empty()) x(x.size() - 1) = 1.;
  return x;
}

ResidualExcess residual_excess(const PreparedRecord& record, const std::vector<Complex>& nominal,
                               const Prediction& prediction, std::vector<double> variance) {
  for (std::size_t b = 0; b < variance.size(); ++b)
    variance[b] += (own_noise_margin - 1.) * prediction.process_noise[b];
  std::vector<Complex> error = difference(record.moment, prediction.mean);
  IntegratedNuisances(prediction.unknowns, error, variance).remove_from(error);
  double power = 0., before = 0., allowed = 0., square = 0.;
  for (std::size_t b = first_bin; b < error.size(); ++b) {
    power += std::norm(error[b]);
    before += std::norm(record.moment[b] - nominal[b]);
    allowed += variance[b];
    square += variance[b] * variance[b];
  }
  return {record.name, power / allowed - 1., (power - allowed) / std::sqrt(square),
          before > allowed ? (power - allowed) / (before - allowed) : 1.};
}

}  // namespace

ResidualExcess residual_excess(const Experiment& fitted_on, const Experiment& held_out,
                               const HypothesisFit& fit) {
  Experiment as_fitted = held_out;
  as_fitted.nominal = fitted_on.nominal;
  as_fitted.known = fitted_on.known;
  as_fitted.scales = fitted_on.scales;
  const Eigen::VectorXd x = evaluation_parameters(fitted_on, fit);
  FitPosterior posterior(as_fitted, fit.fit_parameters, fit.hypothesis);
  const std::vector<Prediction> at = posterior.predict(x);
  posterior.update_slow_variance(x, at);
  const double a_variance = posterior.acceleration_variance(x);
  const Chain nominal = fitted_on.nominal_chain();
  ResidualExcess worst;
  for (std::size_t r = 0; r < at.size(); ++r) {
    const PreparedRecord& record = as_fitted.records[r];
    if (record.n_bins() <= first_bin) continue;
    const ResidualExcess left = residual_excess(record, simulate_mean(nominal, record), at[r],
                                                posterior.variance(x, at[r], r, a_variance));
    if (worst.record.empty() || std::pair(contradicted_by(left), left.excess) >
                                    std::pair(contradicted_by(worst), worst.excess))
      worst = left;
  }
  return worst;
}

bool contradicted_by(const ResidualExcess& left) {
  constexpr double most_excess = 0.2, most_deviations = 6., most_of_gap = 0.05;
  return left.excess > most_excess && left.n_deviations > most_deviations &&
         left.share_of_gap > most_of_gap;
}

void refute_contradicted(SearchResult& result, const Experiment& fitted_on,
                         const Experiment& held_out) {
  constexpr std::size_t most_fits = 5;
  constexpr double most_nats_behind = 4.6;  // probability ratio 1 : 100
  std::set<std::size_t> contradicted;
  bool confirmed = false;
  for (const Candidate& candidate : result.candidates) {
    const HypothesisFit& fit = result.fits[candidate.fit];
    const double behind = result.candidates.front().log_posterior - candidate.log_posterior;
    if (fit.hypothesis.is_discrepancy() || behind > most_nats_behind) break;
    if (contradicted.count(candidate.fit) != 0) continue;
    if (contradicted.size() == most_fits) break;
    confirmed = !contradicted_by(residual_excess(fitted_on, held_out, fit));
    if (confirmed) break;
    contradicted.insert(candidate.fit);
  }
  if (contradicted.empty()) return;
  const auto is_refuted = [&](const Candidate& candidate) {
    if (result.fits[candidate.fit].hypothesis.is_discrepancy()) return false;
    return !confirmed || contradicted.count(candidate.fit) != 0;
  };
  for (const Candidate& candidate : result.candidates)
    if (is_refuted(candidate)) result.refuted.push_back(candidate);
  std::erase_if(result.candidates, is_refuted);
  std::stable_sort(result.refuted.begin(), result.refuted.end(),
                   [](const auto& a, const auto& b) { return a.log_posterior > b.log_posterior; });
  set_probabilities(result);
}

}  // namespace vibrissa::diagnosis
