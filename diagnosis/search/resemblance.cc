#include "diagnosis/search/resemblance.h"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/search/effect_size.h"

namespace vibrissa::diagnosis {
namespace {

/// New noise and residual power of a bin, both divided by the predicted variance.
struct NoisyBin {
  double share = 0., power = 0.;
};

/// An unknown addition to a record: squared score and information of its size, both times its
/// variance.
struct Addition {
  double score = 0., information = 0.;
};

/// Change by an effect, over all bins of a fit's records.
struct Overlap {
  /// Inner product of the change of the mean with the residual, with itself, and of the residual
  /// with itself.
  double cross = 0., own = 0., residual = 0.;
  std::vector<NoisyBin> noisy{};
  std::vector<Addition> additions{};
  /// Gain in twice the log likelihood when the noise levels follow what is left. First order does
  /// not tell less than least_share.
  double of_mean() const {
    if (!(own > 0.)) return 0.;
    return -2. * residual * std::log(std::max(least_share, 1. - cross * cross / (own * residual)));
  }

  /// Gain in twice the log likelihood by a multiple of the new noise's variance.
  double of_noise(double multiple) const {
    double sum = 0.;
    for (const NoisyBin& bin : noisy) {
      const double more = multiple * bin.share;
      sum += bin.power * more / (1. + more) - std::log1p(more);
    }
    sum *= 2.;
    for (const Addition& addition : additions) {
      const double more = multiple * addition.information;
      sum += multiple * addition.score / (1. + more) - std::log1p(more);
    }
    return sum;
  }
  /// The multiple with the largest gain, by a search in its logarithm.
  double best_multiple() const {
    constexpr double orders = 14.;
    constexpr int digits = 10;  // binary, of the logarithm
    const auto loss = [&](double log_multiple) { return -of_noise(std::exp(log_multiple)); };
    return std::exp(boost::math::tools::brent_find_minima(loss, -orders, orders, digits).first);
  }
};

/// Bins with less noise than this share of its peak do not determine its size.
void keep_loud(std::vector<NoisyBin>& bins) {
  constexpr double least = 1e-4;
  double peak = 0.;
  for (const NoisyBin& bin : bins) peak = std::max(peak, bin.share);
  std::erase_if(bins, [&](const NoisyBin& bin) { return bin.share <= least * peak; });
}

/// A multiple of the values, when it lies within the effect's ranges.
std::vector<double> resized(const Effect& effect, const std::vector<double>& values,
                            const double factor) {
  const EffectFamily family(effect, size_parameters(effect), values);
  std::vector<double> out = family.values(factor);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Parameter& parameter = effect.parameters[i];
    if (parameter.logarithmic && !(out[i] > 0.)) return {};
    const double x = parameter.coordinate(out[i]);
    if (x < parameter.prior.low || x > parameter.prior.high) return {};
  }
  return out;
}

}  // namespace

struct FitResidual::State {
  const Experiment& experiment;
  const HypothesisFit& fit;
  FitPosterior posterior;
  Chain chain;
  std::vector<Prediction> at;
  FitPosterior::Nuisances nuisances;
  Eigen::VectorXcd mean, error;  // whitened error, without per-record nuisance parameters
  Eigen::VectorXcd noise;        // the error without the discrepancy
  double residual = 0.;          // squared error, relative to noise and discrepancy
  Eigen::VectorXd per_deviation;
  Eigen::MatrixXd columns;     // whitened derivatives of the mean, without nuisance parameters
  Eigen::MatrixXd covariance;  // of their parameters
  ModelDiscrepancy::Solution discrepancy;

  State(const Experiment& of, const HypothesisFit& best)
      : experiment(of),
        fit(best),
        posterior(of, best.fit_parameters, best.hypothesis),
        chain(best.chain(of)),
        at(posterior.predict(fit.x)) {
    posterior.update_slow_variance(fit.x, at);
    const FitPosterior::WhitenedErrors whitened = posterior.whitened_errors(fit.x, at);
    discrepancy = posterior.discrepancy(fit.x, whitened);
    error = whitened.error;
    per_deviation = whitened.per_deviation;
    nuisances = whitened.nuisances;
    noise = error - discrepancy.mean();
    residual = discrepancy.apply_inverse(error).dot(error).real();
    mean.resize(error.size());
    Eigen::Index row = 0;
    for (const Prediction& prediction : at)
      for (const Complex& value : prediction.mean) mean(row++) = value;
    columns = posterior.derivatives(fit.x, at).mean;
    covariance = fit.covariance(posterior.chain_parameters(), posterior.chain_parameters());
    for (Eigen::Index i = 0; i < per_deviation.size(); ++i)
      columns.middleRows(2 * i, 2) *= per_deviation(i);
    remove_nuisances(nuisances, columns);
  }

  /// The addition to the record whose rows begin here.
  Addition addition(const RecordNuisance& unknown, Eigen::Index row) const {
    double score = 0., information = 0.;
    for (const Complex& shape : unknown.shape) {
      const Complex whitened = shape * per_deviation(row);
      score += 2. * (std::conj(whitened) * noise(row++)).real();
      information += 2. * std::norm(whitened);
    }
    return {score * score * unknown.variance, information * unknown.variance};
  }

  /// The overlaps with an effect at each of these values.
  std::vector<Overlap> overlaps(const Effect& effect,
                                const std::span<const std::vector<double>> tried) const {
    std::vector<Chain> extended;
    for (const std::vector<double>& values : tried)
      effect.extend(extended.emplace_back(chain), values, experiment.scales);
    std::vector<Overlap> out;
    predict_together(extended, experiment.records, {},
                     [&](const std::size_t i, const std::vector<Prediction>& moved) {
                       out.push_back(overlap(extended[i], moved));
                     });
    return out;
  }

  Overlap overlap(const Chain& extended, const std::vector<Prediction>& moved) const {
    Eigen::VectorXcd change(mean.size());
    Overlap out;
    Eigen::Index row = 0;
    for (const Prediction& there : moved) {
      for (const RecordNuisance& unknown : there.unknowns)
        if (!unknown.of_start) out.additions.push_back(addition(unknown, row));
      for (std::size_t b = 0; b < there.mean.size(); ++b, ++row) {
        change(row) = (there.mean[b] - mean(row)) * per_deviation(row);
        const double v =
            (there.process_noise[b] + extended.reference_variance * there.acceleration_noise[b]) *
            per_deviation(row) * per_deviation(row);
        out.noisy.push_back({v, std::norm(noise(row))});
      }
    }
    // What the unknowns of a record imitate tells nothing of an effect.
    const Eigen::Map<Eigen::VectorXd> change_parts(reinterpret_cast<double*>(change.data()),
                                                   2 * change.size());
    remove_nuisances(nuisances, change_parts);
    const Eigen::VectorXcd weighed = discrepancy.apply_inverse(change);
    out.cross = weighed.dot(error).real();
    out.residual = residual;
    // Real and imaginary parts are rows of the columns.
    const Eigen::Map<const Eigen::VectorXd> parts(reinterpret_cast<const double*>(weighed.data()),
                                                  2 * weighed.size());
    const Eigen::VectorXd along = columns.transpose() * parts;
    // The information is twice the Gram matrix of the columns.
    const double whole = weighed.dot(change).real();
    out.own = std::max(whole - 2. * along.dot(covariance * along), 1e-9 * whole);
    keep_loud(out.noisy);
    return out;
  }
};

FitResidual::FitResidual(const Experiment& experiment, const HypothesisFit& fit)
    : state_(std::make_unique<State>(experiment, fit)) {}
FitResidual::~FitResidual() = default;

Resemblance FitResidual::resemblance(const Effect& effect,
                                     const std::vector<std::vector<double>>& tried) const {
  Resemblance best;
  const std::vector<Overlap> overlaps = state_->overlaps(effect, tried);
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const Overlap& sum = overlaps[i];
    const double multiple = sum.best_multiple(), of_mean = sum.of_mean(),
                 of_noise = sum.of_noise(multiple), gain = std::max(of_mean, of_noise);
    if (!(gain > best.gain)) continue;
    // Changes of variances are proportional to the square of an effect's size.
    const double factor = of_mean > of_noise ? sum.cross / sum.own : std::sqrt(multiple);
    best = {gain, resized(effect, tried[i], factor)};
  }
  return best;
}

}  // namespace vibrissa::diagnosis
