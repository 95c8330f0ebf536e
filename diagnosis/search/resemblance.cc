#include "diagnosis/search/resemblance.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/search/effect_size.h"

namespace vibrissa::diagnosis {
namespace {

/// New noise and residual power of a bin, both divided by the predicted variance.
struct NoisyBin {
  double share = 0., power = 0.;
};

/// Change by an effect, over all bins of a fit's records.
struct Overlap {
  double cross = 0.,
         own = 0.;  // inner product of the change of the mean with the residual, with itself
  std::vector<NoisyBin> noisy{};
  double of_mean() const { return own > 0. ? 2. * cross * cross / own : 0.; }

  /// Gain in twice the log likelihood by a multiple of the new noise's variance.
  double of_noise(double multiple) const {
    double sum = 0.;
    for (const NoisyBin& bin : noisy) {
      const double more = multiple * bin.share;
      sum += bin.power * more / (1. + more) - std::log1p(more);
    }
    return 2. * sum;
  }
  /// The multiple with the largest gain, by golden-section search in its logarithm.
  double best_multiple() const {
    constexpr double golden = 0.6180339887, orders = 14., enough = 1e-2;
    double low = -orders, high = orders;
    while (high - low > enough) {
      const double a = high - golden * (high - low), b = low + golden * (high - low);
      if (of_noise(std::exp(a)) < of_noise(std::exp(b)))
        low = a;
      else
        high = b;
    }
    return std::exp(0.5 * (low + high));
  }
};

/// Bins with less noise than this share of its peak do not determine its size.
void keep_loud(std::vector<NoisyBin>& bins) {
  constexpr double least = 1e-4;
  double peak = 0.;
  for (const NoisyBin& bin : bins) peak = std::max(peak, bin.share);
  std::erase_if(bins, [&](const NoisyBin& bin) { return bin.share <= least * peak; });
}

Overlap overlap(const Experiment& experiment, const HypothesisFit& fit,
                const std::vector<WhitenedRecord>& residual, const Effect& effect,
                const std::vector<double>& values) {
  Chain chain = fit.chain(experiment);
  effect.extend(chain, values, experiment.scales);
  const std::vector<Prediction> moved = ChainSimulator(chain).predict(experiment.records);
  const double reference = chain.reference_variance;
  Overlap sum;
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const Prediction& there = moved[r];
    for (std::size_t b = 0; b < there.mean.size(); ++b) {
      const Complex d = (there.mean[b] - fit.records[r].mean[b]) / residual[r].deviation[b];
      sum.cross += (std::conj(d) * residual[r].error[b]).real();
      sum.own += std::norm(d);
      const double v = (there.process_noise[b] + reference * there.acceleration_noise[b]) /
                       (residual[r].deviation[b] * residual[r].deviation[b]);
      sum.noisy.push_back({v, std::norm(residual[r].error[b])});
    }
  }
  keep_loud(sum.noisy);
  return sum;
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

Resemblance resemblance(const Experiment& experiment, const HypothesisFit& fit,
                        const std::vector<WhitenedRecord>& residual, const Effect& effect,
                        const std::vector<std::vector<double>>& tried) {
  Resemblance best;
  for (const std::vector<double>& values : tried) {
    const Overlap sum = overlap(experiment, fit, residual, effect, values);
    const double multiple = sum.best_multiple(), of_mean = sum.of_mean(),
                 of_noise = sum.of_noise(multiple), gain = std::max(of_mean, of_noise);
    if (gain <= best.gain) continue;
    // Changes of variances are proportional to the square of an effect's size.
    const double factor = of_mean > of_noise ? sum.cross / sum.own : std::sqrt(multiple);
    best = {gain, resized(effect, values, factor)};
  }
  return best;
}

}  // namespace vibrissa::diagnosis
