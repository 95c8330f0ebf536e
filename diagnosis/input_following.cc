#include "diagnosis/input_following.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnosis/fit_posterior.h"
#include "diagnosis/frequency_block.h"
#include "diagnosis/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

using Bins = std::vector<Complex>;

Bins without_ends(const Bins& lines) {
  return {lines.begin() + 1, lines.end() - 1};
}

/// What may be followed, in the judged bins; noise_free: the foretold moment holds no noise of a
/// channel that its error holds, too.
std::vector<Bins> regressors(const PreparedRecord& record, const FittedRecord& fitted,
                             const bool noise_free) {
  std::vector<Bins> out;
  if (noise_free) out.push_back(fitted.mean);
  const auto judged = [&](std::span<const double> samples) {
    return without_ends(spectrum_of(samples.subspan(record.first, record.n_judged)));
  };
  if (record.excitation.base && !record.acceleration.empty())
    out.push_back(judged(samples_of(record.acceleration, record.n_samples)));
  if (record.excitation.wind && !record.wind.empty()) out.push_back(judged(record.wind));
  return out;
}

/// Power of each bin's error that is no noise: what the fit's variance holds of it, and what the
/// bounds of form errors allow.
struct Systematic {
  std::vector<double> in_variance, allowed;
};

Systematic systematic_power(const Experiment& experiment, const HypothesisFit& fit, std::size_t r) {
  const FittedRecord& fitted = fit.records[r];
  const bool has_form = !fit.hypothesis.effects().empty() && !fit.hypothesis.is_discrepancy();
  const double share = has_form ? fit.x(fit.x.size() - 1) : 0.;
  const double misfit = nominal_misfit(experiment.nominal, experiment.records[r]);
  const std::vector<double> power = neighbour_mean(powers(fitted.mean), form_reach);
  Systematic out;
  for (std::size_t b = 0; b < power.size(); ++b) {
    const double form = fitted.form_errors.linear[b] + fitted.form_errors.nonlinear[b];
    out.in_variance.push_back(misfit * misfit * power[b] + share * form);
    out.allowed.push_back(misfit * misfit * power[b] + form);
  }
  return out;
}

/// Regression of whitened errors, one row a bin; systematic: their power beside the noise's 1.
/// Columns are scaled to one.
double followed(const Eigen::MatrixXcd& columns, const Eigen::VectorXcd& error,
                const double systematic) {
  constexpr double ridge = 1e-6;  // inputs may be one another's multiples in a block
  const Eigen::Index p = columns.cols();
  Eigen::MatrixXcd information = columns.adjoint() * columns;
  information.diagonal().array() += ridge;
  const Eigen::MatrixXcd inverse = information.inverse();
  const Eigen::VectorXcd theta = inverse * (columns.adjoint() * error);
  const double rest =
      (error - columns * theta).squaredNorm() / static_cast<double>(columns.rows() - p);
  Eigen::MatrixXcd covariance = std::max(1., rest) * inverse;
  covariance.diagonal().array() += systematic;
  return theta.dot(covariance.inverse() * theta).real();
}

struct Followed {
  double surplus = 0., expected = 0.;
};

void add_block(const std::vector<Bins>& inputs, const WhitenedRecord& residual,
               const Systematic& systematic, const std::vector<std::size_t>& bins, Followed& out) {
  constexpr double least_noise = 0.05;  // of the variance: what the bounds widened it by is a bound
  const auto n = static_cast<Eigen::Index>(bins.size()),
             p = static_cast<Eigen::Index>(inputs.size());
  Eigen::MatrixXcd columns(n, p);
  Eigen::VectorXcd error(n);
  double form = 0.;
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t b = bins[static_cast<std::size_t>(i)];
    const double variance = residual.deviation[b] * residual.deviation[b];
    const double noise = std::max(variance - systematic.in_variance[b], least_noise * variance);
    error(i) = residual.error[b] * std::sqrt(variance / noise);
    form += systematic.allowed[b] / noise;
    for (Eigen::Index j = 0; j < p; ++j)
      columns(i, j) = inputs[static_cast<std::size_t>(j)][b] / std::sqrt(noise);
  }
  for (Eigen::Index j = 0; j < p; ++j)
    if (const double norm = columns.col(j).norm(); norm > 0.) columns.col(j) /= norm;
  out.surplus += followed(columns, error, form) - static_cast<double>(p);
  out.expected += static_cast<double>(p);
}

/// Bins that anything drives, by blocks of frequencies; blocks that hold few are joined with the
/// next.
std::vector<std::vector<std::size_t>> driven_blocks(const Experiment& experiment,
                                                    const PreparedRecord& record,
                                                    const std::vector<Bins>& inputs) {
  constexpr std::size_t fewest_spare = 6;
  std::vector<std::vector<std::size_t>> blocks;
  std::size_t last = 0;
  for (std::size_t b = 0; b < record.n_bins(); ++b) {
    if (std::ranges::none_of(inputs, [&](const Bins& x) { return std::norm(x[b]) > 0.; })) continue;
    const std::size_t block = frequency_block(experiment, record, b);
    if (blocks.empty() || (block != last && blocks.back().size() >= inputs.size() + fewest_spare)) {
      blocks.emplace_back();
      last = block;
    }
    blocks.back().push_back(b);
  }
  if (!blocks.empty() && blocks.back().size() < inputs.size() + fewest_spare) blocks.pop_back();
  return blocks;
}

}  // namespace

double input_following(const Experiment& experiment, const HypothesisFit& fit) {
  const std::vector<WhitenedRecord> residual = whitened_residual(experiment, fit);
  const Chain chain = fit.chain(experiment);
  // Noise of the axial acceleration is reduced to what its error does not follow (Wiener's share).
  const bool noise_free = chain.cross.empty() && chain.renewed_share == 0.;
  Followed sum;
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const PreparedRecord& record = experiment.records[r];
    if (!record.excitation.base && !record.excitation.wind) continue;
    const std::vector<Bins> inputs = regressors(record, fit.records[r], noise_free);
    if (inputs.empty()) continue;
    const Systematic systematic = systematic_power(experiment, fit, r);
    for (const std::vector<std::size_t>& bins : driven_blocks(experiment, record, inputs))
      add_block(inputs, residual[r], systematic, bins, sum);
  }
  const double deviations = sum.surplus / std::sqrt(sum.expected);
  // Where nothing moved, or a retune made the sensor unstable, nothing can be followed.
  return std::isfinite(deviations) ? deviations : 0.;
}

}  // namespace vibrissa::diagnosis
