#include "diagnosis/search/effect_size.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {
namespace {

/// A record with base motion on both axes and wind, of a sensor with one mode at 35 Hz.
Experiment trial_experiment() {
  constexpr std::size_t n = 1024;
  signals::Record record(500., n);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const std::string& name :
       {signals::channel::base_acceleration, signals::channel::cross_acceleration,
        signals::channel::wind_speed, signals::channel::base_moment}) {
    std::vector<double> x(n);
    for (double& value : x) value = 2. + normal(random);
    record.set_channel(name, std::move(x));
  }
  NominalModel nominal{.modes = {{.frequency_rad_s = 2. * std::numbers::pi * 35.,
                                  .damping_ratio = 0.05,
                                  .base_gain = -1.,
                                  .base_rate = -0.07,
                                  .wind_gain = 1.,
                                  .wind_rate = 0.07}},
                       .has_base = true,
                       .has_wind = true};
  signals::Dataset dataset;
  dataset.records.push_back({"trial", record, {true, true}});
  return prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::as_measured);
}

/// Does the effect change nothing at these values?
bool vanishes(const Effect& effect, const std::vector<double>& values) {
  static const Experiment experiment = trial_experiment();
  constexpr double rounding = 1e-9;
  const Chain nominal{.structure = experiment.nominal, .joint_share = 0.7};
  Chain chain = nominal;
  effect.extend(chain, values, experiment.scales);
  if (chain.reference_variance > 0.) return false;
  const PreparedRecord& record = experiment.records.front();
  const Prediction without = simulate(nominal, record), with = simulate(chain, record);
  const std::vector<double> own = own_noise(with);
  double difference = 0., power = 0.;
  for (std::size_t b = 0; b < with.mean.size(); ++b) {
    difference += std::norm(with.mean[b] - without.mean[b]) + own[b];
    power += std::norm(without.mean[b]);
  }
  return difference < rounding * rounding * power;
}

bool within(const Parameter& parameter, double value) {
  return value >= parameter.value(parameter.prior.low) &&
         value <= parameter.value(parameter.prior.high);
}

/// Is the neutral value beyond the upper bound (at infinity)?
bool vanishes_above(const Parameter& parameter) {
  return parameter.logarithmic && parameter.neutral > parameter.value(parameter.prior.high);
}

}  // namespace

std::vector<std::size_t> size_parameters(const Effect& effect) {
  const std::vector<double>& start = effect.starts.front();
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double neutral = effect.parameters[i].neutral;
    if (start[i] == neutral) continue;
    std::vector<double> values = start;
    values[i] = neutral;
    if (vanishes(effect, values)) return {i};
    moved.push_back(i);
  }
  return moved;
}

EffectFamily::EffectFamily(const Effect& effect, const std::vector<std::size_t>& size_parameters,
                           std::vector<double> start)
    : effect_(effect), sized_(size_parameters), start_(std::move(start)) {
  const Parameter& first = effect.parameters[parameter()];
  largest_share_ =
      std::max(share_at(first.value(first.prior.low)), share_at(first.value(first.prior.high)));
}

std::vector<double> EffectFamily::values(const double share) const {
  std::vector<double> out = start_;
  for (const std::size_t i : sized_) {
    const Parameter& parameter = effect_.parameters[i];
    const double neutral = parameter.neutral;
    if (!parameter.logarithmic)
      out[i] = neutral + share * (start_[i] - neutral);
    else if (vanishes_above(parameter))
      out[i] = start_[i] / share;
    else if (neutral > 0. && within(parameter, neutral))
      out[i] = neutral * std::pow(start_[i] / neutral, share);
    else
      out[i] = start_[i] * share;
  }
  return out;
}

double EffectFamily::share_at(const double value) const {
  const Parameter& parameter = effect_.parameters[this->parameter()];
  const double start = start_[this->parameter()], neutral = parameter.neutral;
  if (!parameter.logarithmic) return (value - neutral) / (start - neutral);
  if (vanishes_above(parameter)) return start / value;
  if (neutral > 0. && within(parameter, neutral))
    return std::log(value / neutral) / std::log(start / neutral);
  return value / start;
}

}  // namespace vibrissa::diagnosis
