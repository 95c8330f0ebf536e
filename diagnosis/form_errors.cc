#include "diagnosis/form_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "diagnosis/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Power by which two fits foretell a record differently, around each bin.
std::vector<double> change(const FittedRecord& a, const FittedRecord& b) {
  std::vector<double> power = powers(difference(a.mean, b.mean));
  for (std::size_t i = 0; i < power.size(); ++i)
    power[i] += std::abs(a.own_noise[i] - b.own_noise[i]);
  return neighbour_mean(power, form_reach);
}

/// A form error hardly changes over a tenth of the first mode's frequency.
double block_hz(const Experiment& experiment) {
  return 0.1 * experiment.scales.first_mode_rad_s / (2. * std::numbers::pi);
}

}  // namespace

double hidden_gain(const Experiment& experiment, const HypothesisFit& fit,
                   const HypothesisFit& fewer) {
  struct Block {
    double explained = 0., freedom = 0.;
  };
  std::map<std::size_t, Block> blocks;  // by frequency
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    const PreparedRecord& record = experiment.records[r];
    const std::vector<double> gained = change(fit.records[r], fewer.records[r]);
    std::vector<double> form(gained.size(), 0.);
    for (const EffectAction& action : fewer.actions) {
      const double share = action.effect->form_error * action.effect->form_error;
      for (std::size_t b = 0; b < form.size(); ++b) form[b] += share * action.power[r][b];
    }
    for (std::size_t b = 0; b < form.size(); ++b) {
      const double frequency_hz = static_cast<double>(b + 1) * record.bin_hz();
      Block& block = blocks[static_cast<std::size_t>(frequency_hz / block_hz(experiment))];
      block.explained += std::min(gained[b], form[b]) / fit.records[r].variance[b];
      block.freedom += form[b] / fit.records[r].variance[b];
    }
  }
  double hidden = 0.;
  for (const auto& [place, block] : blocks)
    hidden += std::max(0., block.explained - std::log1p(block.freedom));
  return std::min(hidden, std::max(0., fit.log_likelihood - fewer.log_likelihood));
}

}  // namespace vibrissa::diagnosis
