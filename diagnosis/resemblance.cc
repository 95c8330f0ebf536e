#include "diagnosis/resemblance.h"

#include <algorithm>

#include "diagnosis/chain_simulation.h"
#include "diagnosis/effect_size.h"

namespace vibrissa::diagnosis {
namespace {

/// Sums over all bins of a fit's records.
struct Overlap {
  double cross = 0., own = 0.;      // of the change of the mean with the residual, with itself
  double excess = 0., square = 0.;  // of the share of new noise, likewise
  double of_mean() const { return own > 0. ? 2. * cross * cross / own : 0.; }
  double of_noise() const { return square > 0. && excess > 0. ? excess * excess / square : 0.; }
};

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
      const double v = (there.own_noise[b] + reference * there.acceleration_noise[b]) /
                       (residual[r].deviation[b] * residual[r].deviation[b]);
      const double w = v / (1. + v);
      sum.excess += w * (std::norm(residual[r].error[b]) - 1.);
      sum.square += w * w;
    }
  }
  return sum;
}

/// A multiple of values that lies within the effect's ranges; else none.
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
    const double gain = std::max(sum.of_mean(), sum.of_noise());
    if (gain <= best.gain) continue;
    best = {gain, sum.of_mean() > sum.of_noise() ? resized(effect, values, sum.cross / sum.own)
                                                 : std::vector<double>{}};
  }
  return best;
}

}  // namespace vibrissa::diagnosis
