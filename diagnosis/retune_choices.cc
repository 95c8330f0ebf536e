#include "diagnosis/retune_choices.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// A retune parameter within this of nominal is nominal: the simulation is not known better than
/// its form follows its own records.
double negligible(const NominalModel& nominal, const std::string& id) {
  constexpr double least = 1e-4, damping_factor = 5.;
  const double misfit =
      std::max(least, id == "drag_error" ? nominal.wind_misfit : nominal.base_misfit);
  return id == "damping" ? damping_factor * misfit : misfit;
}

/// Log density at zero of the marginal of the chosen figures, widened by what is negligible.
double log_density_at_nominal(const NominalModel& nominal, const HypothesisFit& fit,
                              const std::vector<Eigen::Index>& places) {
  const auto n = static_cast<Eigen::Index>(places.size());
  if (n == 0) return 0.;
  Eigen::MatrixXd covariance = fit.covariance(places, places);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeFigure& figure = fit.figures[static_cast<std::size_t>(places[i])];
    const double width = negligible(nominal, figure.effect->id);
    // A shift that moves the prediction no more than the effects' form errors may stem from them.
    const double information = fit.information(places[i], places[i]);
    covariance(i, i) += width * width + 0.5 * fit.form_energy(figure.effect) / information;
  }
  const Eigen::VectorXd x = fit.x(places);
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(covariance);
  const double log_determinant = ldlt.vectorD().array().abs().log().sum();
  return -0.5 * (x.dot(ldlt.solve(x)) + log_determinant +
                 static_cast<double>(n) * std::log(2. * std::numbers::pi));
}

double log_mean(double a, double b) {
  const double high = std::max(a, b);
  return high + std::log(0.5 * (std::exp(a - high) + std::exp(b - high)));
}

}  // namespace

std::vector<RetuneChoice> retune_choices(const NominalModel& nominal, const HypothesisFit& fit) {
  std::vector<Eigen::Index> ratios;
  for (std::size_t i = 0; i < fit.figures.size() && !fit.hypothesis.is_discrepancy(); ++i)
    if (fit.figures[i].nuisance && fit.figures[i].parameter == 0)
      ratios.push_back(static_cast<Eigen::Index>(i));
  std::vector<RetuneChoice> choices;
  for (std::size_t set = 0; set < (std::size_t{1} << ratios.size()); ++set) {
    RetuneChoice choice;
    double as_built = fit.log_evidence, tolerance_at_nominal = 0.;
    std::vector<Eigen::Index> others;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      const FreeFigure& figure = fit.figures[static_cast<std::size_t>(ratios[i])];
      const Prior& tolerance = figure.description.prior;
      if ((set >> i & 1) == 0) {
        others.push_back(ratios[i]);
        tolerance_at_nominal += tolerance.log_density(0.);
        continue;
      }
      choice.named.push_back(figure.effect->id);
      // What is named may lie anywhere in its range.
      as_built -=
          tolerance.log_density(fit.x(ratios[i])) + std::log(tolerance.high - tolerance.low);
    }
    const double exact =
        as_built - tolerance_at_nominal + log_density_at_nominal(nominal, fit, others);
    choice.log_evidence = log_mean(exact, as_built);
    // Where the retuned sensor is unstable there is no answer.
    if (!std::isfinite(choice.log_evidence))
      choice.log_evidence = -std::numeric_limits<double>::infinity();
    choices.push_back(std::move(choice));
  }
  std::sort(choices.begin(), choices.end(), [](const RetuneChoice& a, const RetuneChoice& b) {
    return a.log_evidence > b.log_evidence;
  });
  return choices;
}

}  // namespace vibrissa::diagnosis
