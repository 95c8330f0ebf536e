#include "diagnosis/fit/calibration_choices.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// Posterior conditional on nominal (or negligibly different) values of some parameters, and the
/// log density of that condition.
struct AtNominal {
  RecalibratedPosterior posterior;
  double log_density = 0.;
};

AtNominal at_nominal(const NominalModel& nominal, const HypothesisFit& fit,
                     const RecalibratedPosterior& posterior,
                     const std::vector<Eigen::Index>& indices) {
  AtNominal out{.posterior = posterior};
  const auto n = static_cast<Eigen::Index>(indices.size());
  if (n == 0) return out;
  Eigen::MatrixXd covariance = posterior.covariance(indices, indices);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FitParameter& fit_parameter = fit.fit_parameters[static_cast<std::size_t>(indices[i])];
    const double width = negligible_calibration(nominal, fit_parameter.effect->id);
    const double information = fit.information(indices[i], indices[i]);
    covariance(i, i) += width * width + fit.shift_by_forms(fit_parameter.effect, information);
  }
  const Eigen::VectorXd x = posterior.x(indices);
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(covariance);
  const double log_determinant = ldlt.vectorD().array().abs().log().sum();
  out.log_density = -0.5 * (x.dot(ldlt.solve(x)) + log_determinant +
                            static_cast<double>(n) * std::log(2. * std::numbers::pi));
  const Eigen::MatrixXd columns = posterior.covariance(Eigen::all, indices);
  out.posterior.x -= columns * ldlt.solve(x);
  out.posterior.covariance -= columns * ldlt.solve(Eigen::MatrixXd(columns.transpose()));
  return out;
}

/// Cost of the tolerances in a fit [nats], which is the upper limit of the correction: an
/// optimisation that stopped before the maximum has not paid the cost that its curvature predicts.
double cost_of_tolerances(const HypothesisFit& fit) {
  double sum = 0.;
  for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
    const Prior& tolerance = fit.fit_parameters[i].description.prior;
    if (fit.fit_parameters[i].nuisance && fit.fit_parameters[i].parameter == 0)
      sum += tolerance.log_density(tolerance.centre) -
             tolerance.log_density(fit.x(static_cast<Eigen::Index>(i)));
  }
  return sum;
}

double spread_of_range(const Prior& prior) {
  return (prior.high - prior.low) / std::sqrt(12.);
}

/// Log densities of parameters that are uniform in their range or small, relative to those of
/// normal distributions with the range's spread. Values outside their range by more than their
/// standard deviation are improbable.
double ranges_for_normals(const HypothesisFit& fit, const RecalibratedPosterior& posterior,
                          const std::vector<Eigen::Index>& named) {
  double sum = 0.;
  for (const Eigen::Index index : named) {
    const Prior& range = fit.fit_parameters[static_cast<std::size_t>(index)].description.prior;
    const double x = posterior.x(index), variance = posterior.covariance(index, index),
                 spread = spread_of_range(range), z = x / spread,
                 beyond = std::max({0., range.low - x, x - range.high});
    sum += 0.5 * z * z + 0.5 * std::log(2. * std::numbers::pi / 12.) -
           0.5 * beyond * beyond / variance +
           log_any_magnitude(0.5 * (range.high - range.low), x, variance);
  }
  return sum;
}

double log_mean(double a, double b) {
  const double high = std::max(a, b);
  return high + std::log(0.5 * (std::exp(a - high) + std::exp(b - high)));
}

}  // namespace

double negligible_calibration(const NominalModel& nominal, const std::string& id) {
  constexpr double least = 1e-4, damping_factor = 5.;
  const double misfit =
      std::max(least, id == "drag_error" ? nominal.wind_misfit : nominal.base_misfit);
  return id == "damping" ? damping_factor * misfit : misfit;
}

double log_any_magnitude(const double top, const double x, const double variance) {
  constexpr double least_of_top = 1e-3;
  const double size = std::sqrt(x * x + variance) + least_of_top * top;
  return std::log(0.5 + 0.5 * top / (size * std::log1p(1. / least_of_top)));
}

std::vector<Eigen::Index> calibrations_but(const HypothesisFit& fit,
                                           const std::vector<std::string>& ids) {
  std::vector<Eigen::Index> indices;
  for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
    const FitParameter& fit_parameter = fit.fit_parameters[i];
    if (fit_parameter.nuisance && fit_parameter.parameter == 0 &&
        std::find(ids.begin(), ids.end(), fit_parameter.effect->id) == ids.end())
      indices.push_back(static_cast<Eigen::Index>(i));
  }
  return indices;
}

RecalibratedPosterior recalibrated_posterior(const HypothesisFit& fit,
                                             const std::vector<Eigen::Index>& named) {
  RecalibratedPosterior out{fit.x, fit.covariance, fit.log_evidence};
  const auto n = static_cast<Eigen::Index>(named.size());
  if (n == 0) return out;
  // The tolerance prior is replaced by a normal distribution with the range's spread, which changes
  // the information on the diagonal.
  Eigen::VectorXd more(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Prior& tolerance =
        fit.fit_parameters[static_cast<std::size_t>(named[i])].description.prior;
    const double spread = spread_of_range(tolerance);
    more(i) = 1. / (spread * spread) - 1. / (tolerance.scale * tolerance.scale);
    out.log_evidence += std::log(tolerance.scale / spread);
  }
  const Eigen::VectorXd at = out.x(named);
  const Eigen::MatrixXd columns = fit.covariance(Eigen::all, named);
  const Eigen::MatrixXd core =
      Eigen::MatrixXd::Identity(n, n) + more.asDiagonal() * fit.covariance(named, named);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(core);
  const Eigen::MatrixXd update = lu.solve(Eigen::MatrixXd(more.asDiagonal()));
  const double refund = -0.5 * at.dot(update * at), most = cost_of_tolerances(fit);
  const double believed = refund > most ? most / refund : 1.;
  out.covariance -= columns * update * columns.transpose();
  out.x -= believed * columns * (update * at);
  out.log_evidence += believed * refund - 0.5 * std::log(std::abs(lu.determinant()));
  return out;
}

CalibrationChoice as_simulated_choice(const HypothesisFit& fit) {
  return {.log_evidence = fit.log_evidence - std::numbers::ln2};
}

std::vector<CalibrationChoice> calibration_choices(const NominalModel& nominal,
                                                   const HypothesisFit& fit) {
  std::vector<Eigen::Index> ratios;
  if (!fit.hypothesis.is_discrepancy()) ratios = calibrations_but(fit, {});
  std::vector<CalibrationChoice> choices;
  for (std::size_t set = 0; set < (std::size_t{1} << ratios.size()); ++set) {
    CalibrationChoice choice;
    double tolerance_at_nominal = 0.;
    std::vector<Eigen::Index> named, others;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      const FitParameter& fit_parameter = fit.fit_parameters[static_cast<std::size_t>(ratios[i])];
      if ((set >> i & 1) == 0) {
        others.push_back(ratios[i]);
        tolerance_at_nominal += fit_parameter.description.prior.log_density(0.);
        continue;
      }
      choice.named.push_back(fit_parameter.effect->id);
      named.push_back(ratios[i]);
    }
    const RecalibratedPosterior posterior = recalibrated_posterior(fit, named);
    const AtNominal exactly = at_nominal(nominal, fit, posterior, others);
    const double as_built = posterior.log_evidence + ranges_for_normals(fit, posterior, named),
                 exact = posterior.log_evidence - tolerance_at_nominal + exactly.log_density +
                         ranges_for_normals(fit, exactly.posterior, named);
    const bool leaves_exact = named.empty() && !fit.hypothesis.is_discrepancy();
    choice.log_evidence = leaves_exact ? as_built - std::numbers::ln2 : log_mean(exact, as_built);
    // There is no answer when the recalibrated sensor is unstable.
    if (!std::isfinite(choice.log_evidence))
      choice.log_evidence = -std::numeric_limits<double>::infinity();
    choices.push_back(std::move(choice));
  }
  std::sort(choices.begin(), choices.end(),
            [](const CalibrationChoice& a, const CalibrationChoice& b) {
              return a.log_evidence > b.log_evidence;
            });
  return choices;
}

}  // namespace vibrissa::diagnosis
