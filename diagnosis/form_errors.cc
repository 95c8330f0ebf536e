#include "diagnosis/form_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "diagnosis/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// A form error hardly changes over a tenth of the first mode's frequency.
std::size_t block_of(const Experiment& experiment, const PreparedRecord& record, std::size_t bin) {
  const double block_hz = 0.1 * experiment.scales.first_mode_rad_s / (2. * std::numbers::pi);
  return static_cast<std::size_t>(static_cast<double>(bin + 1) * record.bin_hz() / block_hz);
}

/// Power by which two fits foretell a record differently, around each bin.
std::vector<double> change(const FittedRecord& a, const FittedRecord& b) {
  std::vector<double> power = powers(difference(a.mean, b.mean));
  for (std::size_t i = 0; i < power.size(); ++i)
    power[i] += std::abs(a.own_noise[i] - b.own_noise[i]);
  return neighbour_mean(power, form_reach);
}

bool adds_nonlinear(const HypothesisFit& fit, const HypothesisFit& fewer) {
  return std::any_of(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end(),
                     [&](const Effect* effect) {
                       return !fewer.hypothesis.contains(effect->id) && is_nonlinear(*effect);
                     });
}

}  // namespace

double hidden_gain(const Experiment& experiment, const HypothesisFit& fit,
                   const HypothesisFit& fewer) {
  struct Sums {
    double explained = 0., freedom = 0.;
  };
  std::map<std::size_t, Sums> blocks;
  const bool nonlinear = adds_nonlinear(fit, fewer);
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const std::vector<double> gained = change(fit.records[r], fewer.records[r]);
    const FormErrors& errors = fewer.records[r].form_errors;
    for (std::size_t b = 0; b < gained.size(); ++b) {
      const double form = errors.nonlinear[b] + (nonlinear ? 0. : errors.linear[b]);
      Sums& block = blocks[block_of(experiment, experiment.records[r], b)];
      block.explained += std::min(gained[b], form) / fit.records[r].variance[b];
      block.freedom += form / fit.records[r].variance[b];
    }
  }
  double hidden = 0.;
  for (const auto& [place, block] : blocks)
    hidden += std::max(0., block.explained - std::log1p(block.freedom));
  // A retune without which the sensor is unstable has no form error that could be told.
  if (!std::isfinite(hidden)) return 0.;
  return std::min(hidden, std::max(0., fit.log_likelihood - fewer.log_likelihood));
}

}  // namespace vibrissa::diagnosis
