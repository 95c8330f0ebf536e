// Are the probabilities of answers as often right as they say? score_calibration SIMULATION N SEED:
// N sensors with effects of the nominal model's own catalogue move as the simulation's records
// do, are measured with noise and diagnosed. Prints every trial, how often answers of a probability
// were right, and the temperature that would make them as often right as they say.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <random>
#include <string>

#include "benchmarks/labelled_set.h"
#include "diagnosis/chain_simulation.h"
#include "diagnosis/diagnosis.h"
#include "diagnosis/effect_size.h"
#include "diagnosis/linear_response.h"
#include "diagnosis/nominal_identification.h"
#include "diagnosis/planned_records.h"
#include "diagnosis/spectrum.h"

namespace {

using namespace vibrissa;
using diagnosis::Complex;
namespace channel = signals::channel;

/// One sensor, and what it is.
class Sensor {
 public:
  Sensor(const diagnosis::Experiment& experiment, unsigned seed) : random_(seed) {
    model_.nominal = experiment.nominal;
    draw_retunes(experiment);
    draw_effects(experiment);
  }

  const std::string& name() const { return name_; }
  double share() const { return share_; }
  /// inputs: what moves it; clean: the same, prepared.
  signals::Dataset measure(const signals::Dataset& inputs,
                           const std::vector<diagnosis::PreparedRecord>& clean);

 private:
  void draw_retunes(const diagnosis::Experiment& experiment);
  void draw_effects(const diagnosis::Experiment& experiment);
  std::vector<double> retuned(const diagnosis::Effect& effect);
  double drawn(const diagnosis::Parameter& parameter);
  void add_own_noise(const diagnosis::Chain& chain, const signals::DatasetRecord& entry,
                     std::vector<double>& moment);
  std::vector<double> with_noise(std::span<const double> x, double deviation);
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  std::mt19937 random_;
  diagnosis::MendedModel model_;
  std::string name_;
  double share_ = 0.;  // of the effects' first starts
};

/// Half of all sensors are as simulated but for what is named, the others a little off in all
/// retunes.
void Sensor::draw_retunes(const diagnosis::Experiment& experiment) {
  if (uniform(0., 1.) < 0.5) return;
  for (const std::string& id : diagnosis::nuisance_ids()) {
    const diagnosis::Effect& effect = diagnosis::find_effect(id);
    if (!diagnosis::shows(experiment, effect)) continue;
    std::vector<double> values;
    for (const diagnosis::Parameter& parameter : effect.parameters)
      values.push_back(drawn(parameter));
    model_.effects.push_back({id, values, experiment.scales});
  }
}

/// What is named of a retune may lie anywhere in its range.
std::vector<double> Sensor::retuned(const diagnosis::Effect& effect) {
  std::vector<double> values;
  for (const diagnosis::Parameter& parameter : effect.parameters)
    values.push_back(values.empty()
                         ? parameter.value(uniform(parameter.prior.low, parameter.prior.high))
                         : drawn(parameter));
  return values;
}

/// By its tolerance.
double Sensor::drawn(const diagnosis::Parameter& parameter) {
  const diagnosis::Prior& prior = parameter.prior;
  const double step = prior.kind == diagnosis::Prior::Kind::normal
                          ? std::normal_distribution<double>()(random_)
                          : std::student_t_distribution<double>(6.)(random_);
  return parameter.value(std::clamp(prior.centre + prior.scale * step, prior.low, prior.high));
}

void Sensor::draw_effects(const diagnosis::Experiment& experiment) {
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
    if (effect->retune) {
      model_.effects.push_back({effect->id, retuned(*effect), experiment.scales});
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

std::vector<double> Sensor::with_noise(std::span<const double> x, const double deviation) {
  std::normal_distribution<double> normal(0., deviation);
  std::vector<double> out(x.begin(), x.end());
  for (double& value : out) value += normal(random_);
  return out;
}

/// Of the effects: a course by their spectrum, and the line of a random walk.
void Sensor::add_own_noise(const diagnosis::Chain& chain, const signals::DatasetRecord& entry,
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
  const double rise =
      std::sqrt(chain.ramp_variance_rate * static_cast<double>(n) / rate_hz) * normal(random_);
  for (std::size_t i = 0; i < n; ++i)
    moment[i] += course[i] + rise * (static_cast<double>(i) / static_cast<double>(n) - 0.5);
}

signals::Dataset Sensor::measure(const signals::Dataset& inputs,
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

/// The simulation's records, and one at rest.
signals::Dataset inputs_of(const signals::Dataset& simulation) {
  signals::Dataset out = simulation;
  signals::Record still(simulation.records.front().record.sampling_rate_hz(), 2048);
  for (const std::string& name : simulation.records.front().record.channel_names())
    still.set_channel(name, std::vector<double>(still.n_samples(), 0.));
  out.records.insert(out.records.begin(), {"quiet", std::move(still), {}});
  return out;
}

struct Trial {
  std::vector<double> probability;  // of all answers, the best first
  std::ptrdiff_t truth = -1;        // place of the true one, -1: not among them
};

/// - log probability of the truth at a temperature; what is not among the answers had one in 10^4.
double surprise(const std::vector<Trial>& trials, const double temperature) {
  constexpr double unlisted = 1e-4;
  double sum = 0.;
  for (const Trial& trial : trials) {
    double total = std::pow(unlisted, 1. / temperature);
    const double unlisted_power = total;
    for (const double p : trial.probability) total += std::pow(p, 1. / temperature);
    const double truth =
        trial.truth < 0
            ? unlisted_power
            : std::pow(trial.probability[static_cast<std::size_t>(trial.truth)], 1. / temperature);
    sum -= std::log(std::max(truth / total, 1e-12));
  }
  return sum / static_cast<double>(trials.size());
}

void print_reliability(const std::vector<Trial>& trials) {
  constexpr double edges[] = {0., 0.5, 0.8, 0.95, 0.99, 1.};
  double error = 0.;
  for (std::size_t i = 0; i + 1 < std::size(edges); ++i) {
    double n = 0., right = 0., said = 0.;
    for (const Trial& trial : trials) {
      const double p = trial.probability.front();
      if (p <= edges[i] || p > edges[i + 1]) continue;
      n += 1.;
      right += trial.truth == 0;
      said += p;
    }
    if (n == 0.) continue;
    error += std::abs(said - right);
    std::printf("said %.2f..%.2f: %3.0f answers, mean %.3f, right %.3f\n", edges[i], edges[i + 1],
                n, said / n, right / n);
  }
  double best = 1.;
  for (double t = 0.3; t < 6.; t *= 1.05)
    if (surprise(trials, t) < surprise(trials, best)) best = t;
  std::printf(
      "expected calibration error %.3f; surprise %.3f nats, at best %.3f at temperature %.2f\n",
      error / static_cast<double>(trials.size()), surprise(trials, 1.), surprise(trials, best),
      best);
}

int run(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: score_calibration SIMULATION N SEED\n";
    return 2;
  }
  const signals::Dataset simulation = signals::read_dataset(argv[1]);
  const diagnosis::NominalModel nominal = diagnosis::identify_nominal(simulation);
  const signals::Dataset inputs = inputs_of(simulation);
  const diagnosis::Experiment experiment = diagnosis::prepare_experiment(
      nominal, inputs, signals::Split::fit, diagnosis::InputNoise::as_measured);
  std::vector<diagnosis::PreparedRecord> clean = experiment.records;
  const diagnosis::Experiment held_out = diagnosis::prepare_experiment(
      nominal, inputs, signals::Split::held_out, diagnosis::InputNoise::as_measured);
  clean.insert(clean.end(), held_out.records.begin(), held_out.records.end());
  std::vector<Trial> trials;
  const auto first = static_cast<unsigned>(std::stoul(argv[3]));
  for (unsigned i = 0; i < std::stoul(argv[2]); ++i) {
    Sensor sensor(experiment, first + i);
    const diagnosis::Diagnosis answer = diagnosis::diagnose(nominal, sensor.measure(inputs, clean));
    Trial trial;
    for (std::size_t k = 0; k < answer.ranking.size(); ++k) {
      trial.probability.push_back(answer.ranking[k].probability);
      if (answer.ranking[k].name == sensor.name()) trial.truth = static_cast<std::ptrdiff_t>(k);
    }
    std::printf("%u %-6s %-40s at %.2f  %-44s %.3f\n", first + i,
                trial.truth == 0 ? "right" : "wrong", sensor.name().c_str(), sensor.share(),
                answer.verdict.c_str(), trial.probability.front());
    std::fflush(stdout);
    trials.push_back(std::move(trial));
  }
  print_reliability(trials);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return benchmarks::guarded([&] { return run(argc, argv); });
}
