#include "separation/identification/piece_scatter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "separation/identification/output_error_problem.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

constexpr std::size_t fewest_pieces = 3;

struct PieceEstimate {
  Eigen::VectorXd step;      // from the model's parameters
  Eigen::VectorXd variance;  // of each
};

std::vector<Segment> pieces_of(std::span<const Segment> segments) {
  if (segments.size() >= fewest_pieces) return {segments.begin(), segments.end()};
  std::vector<Segment> pieces;
  for (const Segment& segment : segments) {
    const std::size_t length = segment.base_moment.size() / fewest_pieces;
    for (std::size_t i = 0; i < fewest_pieces; ++i)
      pieces.push_back({segment.base_acceleration.subspan(i * length, length),
                        segment.base_moment.subspan(i * length, length)});
  }
  return pieces;
}

/// Nothing for a piece that is too short or does not determine the unknowns.
std::optional<PieceEstimate> estimate(const FittedBvrm& fit, const Segment& piece, double rate_hz,
                                      const OutputErrorOptions& options) {
  const std::size_t n_modes = fit.model.modes.size();
  const auto most_unknowns = static_cast<std::size_t>(n_parameters(n_modes, true)) + 2 * n_modes +
                             1;  // with initial state and offset
  const auto delay = static_cast<std::size_t>(std::abs(fit.model.delay_s) * rate_hz) + 1;
  if (piece.base_moment.size() < 4 * most_unknowns + delay) return std::nullopt;
  OutputErrorProblem problem(n_modes, fit.model.delay_s, std::span(&piece, 1), rate_hz, options);
  const Eigen::Index m = problem.n_model_parameters();
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(problem.n_unknowns());
  unknowns.head(m) = to_parameters(fit.model, options.direct_term);
  NormalEquations equations;
  if (!problem.linearise(unknowns, equations)) return std::nullopt;
  const Eigen::MatrixXd inverse = inverse_information(equations.matrix);
  if (inverse.size() == 0) return std::nullopt;
  const Eigen::VectorXd step = inverse * equations.gradient;
  const double cost = equations.cost - step.dot(equations.gradient);
  const double variance =
      std::max(0., cost) / (problem.n_samples() - static_cast<double>(problem.n_free()));
  return PieceEstimate{step.head(m), variance * inverse.diagonal().head(m)};
}

/// chi^2 of the estimates of one unknown about their weighted mean.
double chi_square(const std::vector<PieceEstimate>& pieces, Eigen::Index unknown) {
  double weights = 0., sum = 0., result = 0.;
  for (const PieceEstimate& piece : pieces) {
    weights += 1. / piece.variance[unknown];
    sum += piece.step[unknown] / piece.variance[unknown];
  }
  for (const PieceEstimate& piece : pieces)
    result += std::pow(piece.step[unknown] - sum / weights, 2) / piece.variance[unknown];
  return result;
}

// 99 % limit of chi^2 (Wilson & Hilferty 1931).
double chi_square_limit(double n_degrees) {
  constexpr double normal = 2.326348;
  const double spread = 2. / (9. * n_degrees);
  return n_degrees * std::pow(1. - spread + normal * std::sqrt(spread), 3);
}

std::string words_of(const FittedBvrm& fit, const Eigen::VectorXd& factor) {
  std::string modes;
  for (std::size_t k = 0; k < fit.modes.size(); ++k) {
    const auto first = parameters_per_mode * static_cast<Eigen::Index>(k);
    const bool frequency = factor[first + 3] > 1., damping = factor[first + 2] > 1.;
    if (!frequency && !damping) continue;
    modes += (modes.empty() ? "" : "; ") +
             std::string(frequency && damping ? "frequency and damping"
                         : frequency          ? "frequency"
                                              : "damping") +
             " of the mode at " +
             signals::to_text(std::round(100. * fit.modes[k].frequency_hz.value) / 100.) + " Hz";
  }
  return modes.empty() ? modes
                       : "the parts of the record disagree by more than noise about: " + modes +
                             "; the deviations are widened accordingly";
}

}  // namespace

ScatteredFit widen_by_scatter(const FittedBvrm& fit, std::span<const Segment> segments,
                              double sampling_rate_hz, const OutputErrorOptions& options) {
  std::vector<PieceEstimate> pieces;
  if (fit.covariance.allFinite())
    for (const Segment& piece : pieces_of(segments))
      if (auto found = estimate(fit, piece, sampling_rate_hz, options))
        pieces.push_back(std::move(*found));
  if (pieces.size() < 2) return {fit, {}};
  const auto n_degrees = static_cast<double>(pieces.size() - 1);
  Eigen::VectorXd factor = Eigen::VectorXd::Ones(fit.covariance.rows());
  for (Eigen::Index j = 0; j < factor.size(); ++j) {
    if (!(fit.covariance(j, j) > 0.)) continue;
    const double chi2 = chi_square(pieces, j);
    if (chi2 > chi_square_limit(n_degrees)) factor[j] = std::sqrt(chi2 / n_degrees);
  }
  FittedBvrm widened = make_fitted(to_parameters(fit.model, options.direct_term),
                                   factor.asDiagonal() * fit.covariance * factor.asDiagonal(),
                                   options.direct_term, fit.model.delay_s);
  widened.residual_variance = fit.residual_variance;
  widened.end = fit.end;
  widened.n_iterations = fit.n_iterations;
  return {std::move(widened), words_of(fit, factor)};
}

}  // namespace vibrissa::separation
