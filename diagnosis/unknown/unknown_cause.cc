#include "diagnosis/unknown/unknown_cause.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "diagnosis/model/parallel.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

constexpr std::size_t most_terms = 3;
constexpr double least_gain = 0.05;

/// Real and imaginary parts of all bins of the records that move, one after the other.
Eigen::VectorXd stacked(std::span<const PreparedRecord> records,
                        const std::vector<std::vector<Complex>>& bins) {
  std::vector<double> out;
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (!records[r].excitation.base && !records[r].excitation.wind) continue;
    for (const Complex value : bins[r]) {
      out.push_back(value.real());
      out.push_back(value.imag());
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

Eigen::VectorXd measured_in(const Experiment& experiment) {
  std::vector<std::vector<Complex>> bins;
  for (const PreparedRecord& record : experiment.records) bins.push_back(record.moment);
  return stacked(experiment.records, bins);
}

/// Terms with their coefficients on top of a chain.
class Model {
 public:
  Model(Chain chain, const std::vector<Term>& terms, std::size_t threads)
      : n_threads(threads), chain_(std::move(chain)), terms_(terms) {}

  const std::size_t n_threads;

  struct Choice {
    std::vector<std::size_t> terms{};
    Eigen::VectorXd coefficients{};
  };

  Eigen::VectorXd predicted(std::span<const PreparedRecord> records, const Choice& choice) const {
    Chain chain = chain_;
    for (std::size_t i = 0; i < choice.terms.size(); ++i)
      terms_[choice.terms[i]].add(chain, choice.coefficients(static_cast<Eigen::Index>(i)));
    return stacked(records, ChainSimulator(chain).means(records));
  }
  /// The choice with a further term of coefficient zero.
  static Choice extended(const Choice& choice, std::size_t term) {
    Choice out = choice;
    out.terms.push_back(term);
    out.coefficients.conservativeResize(out.coefficients.size() + 1);
    out.coefficients(out.coefficients.size() - 1) = 0.;
    return out;
  }
  /// Derivative of the prediction by coefficient i of a choice.
  Eigen::VectorXd slope(std::span<const PreparedRecord> records, Choice choice, Eigen::Index i,
                        const Eigen::VectorXd& at) const {
    constexpr double step = 1e-3;  // of the peak moment
    choice.coefficients(i) += step;
    return (predicted(records, choice) - at) / step;
  }

 private:
  Chain chain_;
  const std::vector<Term>& terms_;
};

/// Least squares. Where columns are nearly dependent (mass, and stiffness with damping and gain),
/// the smallest solution in terms of their sizes.
Eigen::VectorXd solved(const Eigen::MatrixXd& columns, const Eigen::VectorXd& right) {
  constexpr double dependent = 0.01;
  const Eigen::VectorXd sizes = columns.colwise().norm().cwiseMax(1e-300);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(dependent);
  factors.compute(columns * sizes.cwiseInverse().asDiagonal());
  return factors.solve(right).cwiseQuotient(sizes);
}

/// Slopes of the prediction by these coefficients of a choice, one column each.
Eigen::MatrixXd slopes_of(const Model& model, std::span<const PreparedRecord> records,
                          const Model::Choice& choice, const Eigen::VectorXd& at) {
  Eigen::MatrixXd out(at.size(), choice.coefficients.size());
  for_each_parallel(static_cast<std::size_t>(out.cols()), model.n_threads, [&](std::size_t i) {
    const auto column = static_cast<Eigen::Index>(i);
    out.col(column) = model.slope(records, choice, column, at);
  });
  return out;
}

/// Gauss-Newton steps, halved until the error falls. Slopes are kept as long as the steps with them
/// succeed.
Model::Choice fitted(const Model& model, std::span<const PreparedRecord> records,
                     const Eigen::VectorXd& measured, Model::Choice choice) {
  constexpr int most_steps = 12, most_halvings = 4;
  constexpr double least_progress = 1e-3, good_progress = 0.3;
  Eigen::VectorXd at = model.predicted(records, choice);
  Eigen::MatrixXd slopes;
  bool is_stale = true;
  for (int step = 0; step < most_steps; ++step) {
    const bool are_new = is_stale;
    if (is_stale) slopes = slopes_of(model, records, choice, at);
    const Eigen::VectorXd error = measured - at;
    const Eigen::VectorXd way = solved(slopes, error);
    double factor = 1., gain = 0.;
    for (int halving = 0; halving < most_halvings && gain <= 0.; ++halving, factor *= 0.5) {
      Model::Choice next = choice;
      next.coefficients += factor * way;
      const Eigen::VectorXd there = model.predicted(records, next);
      gain = 1. - (measured - there).squaredNorm() / error.squaredNorm();
      if (!(gain > 0.)) continue;
      choice = next;
      at = there;
    }
    if (!(gain > least_progress) && are_new) break;
    is_stale = !(gain > good_progress);
  }
  return choice;
}

/// The terms that would take away most of the error power to first order, beside those of the
/// choice.
std::vector<std::size_t> promising_additions(const Model& model, const std::vector<Term>& terms,
                                             std::span<const PreparedRecord> records,
                                             const Eigen::VectorXd& measured,
                                             const Model::Choice& choice) {
  const Eigen::VectorXd at = model.predicted(records, choice);
  const Eigen::MatrixXd known = slopes_of(model, records, choice, at);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(known);
  const Eigen::MatrixXd basis =
      qr.householderQ() * Eigen::MatrixXd::Identity(known.rows(), known.cols());
  const auto without_known = [&](Eigen::VectorXd x) {
    x -= basis * (basis.transpose() * x);
    return x;
  };
  const Eigen::VectorXd error = without_known(measured - at);
  constexpr std::size_t n_promising = 3;
  std::vector<std::pair<double, std::size_t>> gains(terms.size());
  for_each_parallel(terms.size(), model.n_threads, [&](std::size_t t) {
    gains[t] = {0., t};
    if (std::ranges::find(choice.terms, t) != choice.terms.end()) return;
    const Model::Choice wider = Model::extended(choice, t);
    const Eigen::VectorXd slope = model.slope(records, wider, choice.coefficients.size(), at);
    const Eigen::VectorXd column = without_known(slope);
    constexpr double parallel = 1e-6;
    if (column.squaredNorm() > parallel * slope.squaredNorm())
      gains[t].first = -std::pow(column.dot(error), 2) / column.squaredNorm();
  });
  std::sort(gains.begin(), gains.end());
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < std::min(n_promising, gains.size()); ++i)
    if (gains[i].first < 0.) out.push_back(gains[i].second);
  return out;
}

/// The choice with the further term that leaves the least error once all coefficients are fitted;
/// nothing where no term is left.
std::optional<Model::Choice> widened(const Model& model, const std::vector<Term>& terms,
                                     std::span<const PreparedRecord> records,
                                     const Eigen::VectorXd& measured, const Model::Choice& choice) {
  std::optional<Model::Choice> best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t t : promising_additions(model, terms, records, measured, choice)) {
    Model::Choice wider = fitted(model, records, measured, Model::extended(choice, t));
    const double error = (measured - model.predicted(records, wider)).squaredNorm();
    if (!(error < least)) continue;
    least = error;
    best = std::move(wider);
  }
  return best;
}

}  // namespace

UnknownCause describe_unknown(const Experiment& experiment, const Experiment& scored,
                              const HypothesisFit& fit, const double noise_share,
                              const std::size_t n_threads) {
  const std::vector<Term> terms = all_terms(experiment, scored.records);
  const Chain chain = fit.chain(experiment);
  const Model model(chain, terms, n_threads);
  const Eigen::VectorXd measured = measured_in(experiment), unseen = measured_in(scored);
  const auto error_of = [&](const Model::Choice& choice) {
    return (unseen - model.predicted(scored.records, choice)).squaredNorm();
  };
  const double before = error_of({}), noise = noise_share * before;
  UnknownCause out;
  out.unexplained = (before - noise) / unseen.squaredNorm();
  const auto closed_by = [&](const Model::Choice& choice) {
    return (before - error_of(choice)) / (before - noise);
  };
  Model::Choice choice;
  for (std::size_t t = 0; t < terms.size(); ++t)
    if (terms[t].basic) choice = Model::extended(choice, t);
  choice = fitted(model, experiment.records, measured, choice);
  double closed = closed_by(choice);
  while (out.terms.size() < most_terms) {
    const auto wider = widened(model, terms, experiment.records, measured, choice);
    const double now = wider ? closed_by(*wider) : 0.;
    if (!(now > closed + least_gain)) break;
    choice = *wider;
    closed = now;
    const Term& term = terms[choice.terms.back()];
    out.terms.push_back({.name = term.name, .place = term.place, .like = term.like, .closes = now});
    // All coefficients move when one is added.
    const std::size_t first = choice.terms.size() - out.terms.size();
    for (std::size_t i = 0; i < out.terms.size(); ++i)
      out.terms[i].coefficient = choice.coefficients(static_cast<Eigen::Index>(first + i));
  }
  out.left = (1. - (out.terms.empty() ? 0. : closed)) * out.unexplained;
  out.residual = residual_moment(experiment, chain);
  return out;
}

}  // namespace vibrissa::diagnosis
