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

/// Of a linear effect's form little is unknown: its error explains no more than this, in nats.
constexpr double most_hidden_by_linear = 40.;

double hidden_by(const Experiment& experiment, const HypothesisFit& fit, const HypothesisFit& fewer,
                 bool linear) {
  struct Sums {
    double explained = 0., freedom = 0.;
  };
  std::map<std::size_t, Sums> blocks;
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const std::vector<double> gained = change(fit.records[r], fewer.records[r]);
    const FormErrors& errors = fewer.records[r].form_errors;
    for (std::size_t b = 0; b < gained.size(); ++b) {
      const double form = errors.nonlinear[b] + (linear ? errors.linear[b] : 0.);
      Sums& block = blocks[block_of(experiment, experiment.records[r], b)];
      block.explained += std::min(gained[b], form) / fit.records[r].variance[b];
      block.freedom += form / fit.records[r].variance[b];
    }
  }
  double hidden = 0.;
  for (const auto& [place, block] : blocks)
    hidden += std::max(0., block.explained - std::log1p(block.freedom));
  // A retune without which the sensor is unstable has no form error that could be told.
  return std::isfinite(hidden) ? hidden : 0.;
}

}  // namespace

double hidden_gain(const Experiment& experiment, const HypothesisFit& fit,
                   const HypothesisFit& fewer) {
  double hidden = hidden_by(experiment, fit, fewer, false);
  if (!adds_nonlinear(fit, fewer))
    hidden +=
        std::clamp(hidden_by(experiment, fit, fewer, true) - hidden, 0., most_hidden_by_linear);
  return std::min(hidden, std::max(0., fit.log_likelihood - fewer.log_likelihood));
}

}  // namespace vibrissa::diagnosis
