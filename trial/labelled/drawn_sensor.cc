#include "trial/labelled/drawn_sensor.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "diagnosis/model/hypothesis.h"
#include "diagnosis/planning/planned_records.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/response/linear_response.h"
#include "diagnosis/search/effect_size.h"

namespace vibrissa::benchmarks {

using diagnosis::Complex;
namespace channel = signals::channel;

DrawnSensor::DrawnSensor(const diagnosis::Experiment& experiment, unsigned seed) : random_(seed) {
  model_.nominal = experiment.nominal;
  draw_calibrations(experiment);
  draw_effects(experiment);
}

const std::vector<double>& DrawnSensor::values(const std::string& effect) const {
  return std::find_if(model_.effects.begin(), model_.effects.end(),
                      [&](const auto& known) { return known.id == effect; })
      ->values;
}

std::string DrawnSensor::shown_name(const diagnosis::NominalPoint& point) const {
  constexpr double deviations_to_detect = 2.576;  // normal quantile of 0.995
  std::vector<std::string> shown;
  for (const std::string& id : diagnosis::effect_ids(name_)) {
    const Eigen::VectorXd change = point.change(point.x(), diagnosis::find_effect(id), values(id));
    const double nats = change.squaredNorm() + point.beyond_square(change);
    if (2. * nats >= deviations_to_detect * deviations_to_detect) shown.push_back(id);
  }
  return diagnosis::joined_name(shown);
}

bool DrawnSensor::is_answered_by(const std::string& answer,
                                 const diagnosis::NominalPoint& point) const {
  const std::vector<std::string> expected = diagnosis::effect_ids(shown_name(point)),
                                 told = diagnosis::effect_ids(answer);
  const auto holds = [](const std::vector<std::string>& list, const std::string& id) {
    return std::ranges::find(list, id) != list.end();
  };
  const std::vector<std::string>& calibrations = diagnosis::nuisance_ids();
  return std::ranges::all_of(expected, [&](const auto& id) { return holds(told, id); }) &&
         std::ranges::all_of(told, [&](const auto& id) {
           return holds(expected, id) || (as_built_ && holds(calibrations, id));
         });
}

/// Half of all sensors are as simulated apart from the named effects; the others deviate by
/// building tolerances in all calibration parameters.
void DrawnSensor::draw_calibrations(const diagnosis::Experiment& experiment) {
  as_built_ = uniform(0., 1.) >= 0.5;
  if (!as_built_) return;
  for (const std::string& id : diagnosis::nuisance_ids()) {
    const diagnosis::Effect& effect = diagnosis::find_effect(id);
    if (!diagnosis::shows(experiment, effect)) continue;
    std::vector<double> values;
    for (const diagnosis::Parameter& parameter : effect.parameters)
      values.push_back(drawn(parameter));
    model_.effects.push_back({id, values, experiment.scales});
  }
}

/// A named calibration parameter has its full range.
std::vector<double> DrawnSensor::recalibrated(const diagnosis::Effect& effect) {
  std::vector<double> values;
  for (const diagnosis::Parameter& parameter : effect.parameters)
    values.push_back(values.empty()
                         ? parameter.value(uniform(parameter.prior.low, parameter.prior.high))
                         : drawn(parameter));
  return values;
}

/// Draw within the tolerance.
double DrawnSensor::drawn(const diagnosis::Parameter& parameter) {
  const diagnosis::Prior& prior = parameter.prior;
  const double step = prior.kind == diagnosis::Prior::Kind::normal
                          ? std::normal_distribution<double>()(random_)
                          : std::student_t_distribution<double>(6.)(random_);
  return parameter.value(std::clamp(prior.centre + prior.scale * step, prior.low, prior.high));
}

void DrawnSensor::draw_effects(const diagnosis::Experiment& experiment) {
  std::vector<const diagnosis::Effect*> effects;
  for (const diagnosis::Effect& effect : diagnosis::effect_catalogue())
    if (diagnosis::shows(experiment, effect)) effects.push_back(&effect);
  std::shuffle(effects.begin(), effects.end(), random_);
  effects.resize(std::discrete_distribution<std::size_t>({0.25, 0.5, 0.25})(random_));
  share_ = std::exp(uniform(std::log(0.1), 0.));
  std::vector<std::string> ids;
  for (const diagnosis::Effect* effect : effects) {
    ids.push_back(effect->id);
    std::erase_if(model_.effects, [&](const auto& known) { return known.id == effect->id; });
    if (effect->calibration) {
      model_.effects.push_back({effect->id, recalibrated(*effect), experiment.scales});
      continue;
    }
    const auto& starts = effect->starts;
    const std::size_t start =
        std::uniform_int_distribution<std::size_t>(0, starts.size() - 1)(random_);
    const diagnosis::EffectFamily family(*effect, diagnosis::size_parameters(*effect),
                                         starts[start]);
    model_.effects.push_back(
        {effect->id, family.values(std::min(share_, family.largest_share())), experiment.scales});
  }
  name_ = diagnosis::joined_name(ids);
}

std::vector<double> DrawnSensor::with_noise(std::span<const double> x, const double deviation) {
  std::normal_distribution<double> normal(0., deviation);
  std::vector<double> out(x.begin(), x.end());
  for (double& value : out) value += normal(random_);
  return out;
}

/// Process noise of the effects: a random signal with their spectrum, tones, and the straight line
/// of a random walk.
void DrawnSensor::add_own_noise(const diagnosis::Chain& chain, const signals::DatasetRecord& entry,
                                std::vector<double>& moment) {
  const std::size_t n = moment.size() - moment.size() % 2;
  const double rate_hz = entry.record.sampling_rate_hz();
  const diagnosis::LinearResponse response(chain);
  const diagnosis::RecordView view{
      .base = entry.excitation.base,
      .wind = entry.excitation.wind,
      .sampling_rate_hz = rate_hz,
      .n_samples = n,
      .wind_speed = entry.excitation.wind ? entry.record.channel(channel::wind_speed).first(n)
                                          : std::span<const double>{},
      .wind_response = [&](std::size_t k) {
        const diagnosis::LinearPart part = response.at(
            {0., 2. * std::numbers::pi * rate_hz * static_cast<double>(k) / static_cast<double>(n)},
            entry.readout);
        return part.wind * part.sensor;
      }};
  std::vector<double> variance(n / 2 - 1, 0.);
  for (const diagnosis::NoiseSource& source : chain.noise) source(view, variance);
  std::vector<Complex> spectrum(n / 2 + 1, 0.);
  std::normal_distribution<double> normal;
  for (std::size_t b = 0; b < variance.size(); ++b)
    spectrum[b + 1] = std::sqrt(0.5 * variance[b]) * Complex(normal(random_), normal(random_));
  const std::vector<double> course = diagnosis::samples_of(spectrum, n);
  const auto add_tone = [&](const diagnosis::Tone& tone) {
    const Complex size =
        tone.amplitude * std::sqrt(0.5) * Complex(normal(random_), normal(random_));
    for (std::size_t i = 0; i < n; ++i)
      moment[i] += std::real(size * std::polar(1., 2. * std::numbers::pi * tone.frequency_hz *
                                                       static_cast<double>(i) / rate_hz));
  };
  for (const diagnosis::Tone& tone : chain.tones) add_tone(tone);
  const double rise =
      std::sqrt(chain.ramp_variance_rate * static_cast<double>(n) / rate_hz) * normal(random_);
  for (std::size_t i = 0; i < n; ++i)
    moment[i] += course[i] + rise * (static_cast<double>(i) / static_cast<double>(n) - 0.5);
}

signals::Dataset DrawnSensor::measure(const signals::Dataset& inputs,
                                      const std::vector<diagnosis::PreparedRecord>& clean) {
  const diagnosis::ChannelNoise noise = diagnosis::usual_noise();
  const diagnosis::Chain chain = model_.chain();
  diagnosis::ChainSimulator simulator(chain);
  const double a_noise = std::hypot(noise.acceleration_m_s2, std::sqrt(chain.reference_variance));
  signals::Dataset out;
  for (const signals::DatasetRecord& entry : inputs.records) {
    std::vector<double> moment(entry.record.n_samples(), 0.);
    for (const diagnosis::PreparedRecord& record : clean)
      if (record.name == entry.name && !record.is_still()) moment = simulator.samples(record);
    add_own_noise(chain, entry, moment);
    signals::DatasetRecord measured = entry;
    for (const std::string& name : {channel::base_acceleration, channel::cross_acceleration})
      if (entry.record.has(name))
        measured.record.set_channel(name, with_noise(entry.record.channel(name), a_noise));
    measured.record.set_channel(channel::base_moment, with_noise(moment, noise.moment_n_m));
    out.records.push_back(std::move(measured));
  }
  return out;
}

}  // namespace vibrissa::benchmarks
