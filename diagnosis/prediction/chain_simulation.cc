#include "diagnosis/prediction/chain_simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/model/parallel.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

std::vector<Complex> wind_force_spectrum(const Chain& chain, const PreparedRecord& record) {
  if (record.wind.empty()) return {};
  std::vector<double> u = record.wind;
  for (const auto& law : chain.wind) law(u, 1. / record.sampling_rate_hz);
  const double factor = chain.drag_factor * record.wind_share;
  for (double& value : u) value = factor * chain.structure.drag_curve.drag(value);
  return spectrum_of(u);
}

/// Derivative of (u - v) |u - v| by the base velocity at rest, root mean square over the wind
/// record.
double drag_per_velocity(const Chain& chain, const PreparedRecord& record) {
  if (record.wind.empty()) return 0.;
  return 2. * chain.relative_wind.base_share * chain.drag_factor * record.wind_share *
         std::sqrt(mean_square(record.wind));
}

Complex reading_of_source(const Chain& chain, const PreparedRecord& record, std::size_t k) {
  const Complex reading = record.acceleration[k];
  if (record.source_acceleration.empty()) return reading;
  return reading + chain.new_sample_share * (record.source_acceleration[k] - reading);
}

std::vector<std::vector<Complex>> evaluated_means(
    std::span<const PreparedRecord> records, const std::vector<std::vector<Complex>>& readings) {
  std::vector<std::vector<Complex>> out;
  for (std::size_t r = 0; r < records.size(); ++r)
    out.push_back(records[r].is_still() ? std::vector<Complex>(records[r].n_bins(), 0.)
                                        : bins_of_lines(records[r], readings[r]));
  return out;
}

void paint(std::span<double> variance, const NoiseColour& colour, const PreparedRecord& record) {
  if (colour.is_white()) return;
  for (std::size_t b = 0; b < variance.size(); ++b)
    variance[b] *= colour.density(record.frequency_hz(b));
}

/// The pole of the first mode, from its nominal place on: Newton's method, with a difference as
/// derivative.
Complex pole_of(const JointModel& joint) {
  constexpr int n_steps = 6;
  constexpr double step = 1e-4;
  const auto residual = [&](const Complex& s) {
    return 1. + joint.changed_inertia(s) *
                    (joint.share / joint.changed_stiffness_ratio(s) + 1. - joint.share);
  };
  Complex s = joint.frequency_rad_s * Complex(-joint.damping - 0.5 * joint.share * joint.loss, 1.);
  for (int i = 0; i < n_steps; ++i) {
    const double h = step * joint.frequency_rad_s;
    s -= residual(s) * h / (residual(s + h) - residual(s));
  }
  return s;
}

/// Of a free decay at the first evaluated sample [(N m)^2]: the circular continuation of a record
/// and its true start differ by twice the variance of the motion.
double variance_of_start(const PreparedRecord& record, const Complex& pole) {
  const double n = static_cast<double>(record.n_evaluated),
               decayed = std::exp(pole.real() * static_cast<double>(record.first) /
                                  record.sampling_rate_hz);
  return 4. * total_power(record.moment) / (n * n) * decayed * decayed;
}

}  // namespace

/// The linear part before the sensor, without the contribution of the transverse axis.
ChainSimulator::Spectra ChainSimulator::linear_moments(std::span<const PreparedRecord> records) {
  Spectra out;
  for (const PreparedRecord& record : records) {
    std::vector<Complex>& moment = out.emplace_back(record.n_samples / 2 + 1, 0.);
    if (record.is_still()) continue;
    const std::vector<LinearPart>& lines = response_.lines(record);
    if (!record.acceleration.empty())
      for (std::size_t k = 0; k < lines.size(); ++k)
        moment[k] = lines[k].base * reading_of_source(chain_, record, k);
    const std::vector<Complex> force = wind_force_spectrum(chain_, record);
    if (!force.empty())
      for (std::size_t k = 0; k < lines.size(); ++k) moment[k] += lines[k].wind * force[k];
  }
  return out;
}

ChainSimulator::Begun ChainSimulator::begin(std::span<const PreparedRecord> records) {
  Begun out{.moments = linear_moments(records)};
  if (!response_.joint()) return out;
  out.task.chain = &chain_;
  out.task.joint = &*response_.joint();
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (records[r].is_still() || records[r].is_response() || !records[r].magnet ||
        !is_dynamic(chain_, records[r]))
      continue;
    const std::vector<LinearPart>& lines = response_.lines(records[r]);
    out.indices.push_back(r);
    std::vector<Complex>& elastic =
        out.task.elastic.emplace_back(ElasticMoment{&records[r], out.moments[r]}).spectrum;
    for (std::size_t k = 0; k < lines.size(); ++k) elastic[k] *= lines[k].elastic;
  }
  return out;
}

std::vector<Complex> ChainSimulator::reading(const PreparedRecord& record,
                                             std::vector<Complex> moment) {
  if (!chain_.readout.empty()) {
    std::vector<double> samples = samples_of(moment, record.n_samples);
    for (const auto& law : chain_.readout)
      for (double& value : samples) value = law(value);
    moment = spectrum_of(samples);
  }
  const std::vector<LinearPart>& lines = response_.lines(record);
  for (std::size_t k = 0; k < moment.size(); ++k) moment[k] *= lines[k].sensor;
  if (chain_.clock_rate_error == 0.) return moment;
  const std::size_t n = record.n_samples;
  const double error = chain_.clock_rate_error;
  const double first = error * record.clock_start_s * record.sampling_rate_hz;
  return spectrum_of(resampled(moment, n, n, first, 1. + error));
}

/// near: the states under a chain that hardly differs; may be nullptr.
std::vector<Complex> ChainSimulator::response_reading(const PreparedRecord& record,
                                                      const std::vector<Complex>& moment,
                                                      const SweepStates* near) {
  std::vector<Complex> out = moment;
  if (is_nonlinear_sweep(chain_, record)) {
    std::shared_ptr<const SweepStates>& own = sweeps_.at(record.number);
    if (near == nullptr && !own) own = std::make_shared<SweepStates>(chain_, record);
    const std::vector<Complex> readings =
        near == nullptr ? own->readings() : near->readings_of(chain_, record);
    for (std::size_t b = 0; b < readings.size(); ++b)
      out[b + 1] = record.sines.per_amplitude * readings[b];
  } else {
    const std::vector<LinearPart>& lines = response_.lines(record);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] *= lines[k].sensor;
  }
  if (record.sines.phase_is_known) return out;
  Complex common = 0.;
  for (std::size_t b = 0; b < record.n_bins(); ++b)
    common += record.moment[b] * std::conj(out[b + 1]);
  if (common == 0.) return out;
  for (Complex& line : out) line *= common / std::abs(common);
  return out;
}

ChainSimulator::Spectra ChainSimulator::finish(std::span<const PreparedRecord> records, Begun begun,
                                               const std::vector<std::vector<double>>& dynamic,
                                               const std::span<const Prediction> near) {
  Spectra moments = std::move(begun.moments);
  for (std::size_t i = 0; i < begun.indices.size(); ++i) {
    const std::vector<Complex> added = spectrum_of(dynamic[i]);
    std::vector<Complex>& moment = moments[begun.indices[i]];
    for (std::size_t k = 0; k < added.size(); ++k) moment[k] += added[k];
  }
  std::vector<std::size_t> responses;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const PreparedRecord& record = records[r];
    if (record.is_still()) continue;
    if (record.is_response()) {
      responses.push_back(r);
      sweeps_.try_emplace(record.number);
      continue;
    }
    if (!record.cross_acceleration.empty()) {
      const std::vector<LinearPart>& lines = response_.lines(record);
      for (std::size_t k = 0; k < lines.size(); ++k)
        moments[r][k] += lines[k].cross * record.cross_acceleration[k];
    }
    moments[r] = reading(record, std::move(moments[r]));
  }
  for_each_parallel(responses.size(), available_threads(), [&](const std::size_t i) {
    const std::size_t r = responses[i];
    moments[r] =
        response_reading(records[r], moments[r], near.empty() ? nullptr : near[r].sweep.get());
  });
  return moments;
}

ChainSimulator::Spectra ChainSimulator::readings(std::span<const PreparedRecord> records) {
  Begun begun = begin(records);
  const auto dynamic = dynamic_parts({&begun.task, 1});
  return finish(records, std::move(begun), dynamic.front());
}

std::vector<std::vector<Complex>> ChainSimulator::means(std::span<const PreparedRecord> records) {
  return evaluated_means(records, readings(records));
}

std::vector<double> ChainSimulator::samples(const PreparedRecord& record) {
  return samples_of(readings({&record, 1}).front(), record.n_samples);
}

std::vector<Prediction> ChainSimulator::predictions(std::span<const PreparedRecord> records,
                                                    const Spectra& readings) {
  std::vector<std::vector<Complex>> mean = evaluated_means(records, readings);
  std::vector<Prediction> out;
  for (std::size_t r = 0; r < records.size(); ++r)
    out.push_back(with_noise(records[r], std::move(mean[r])));
  return out;
}

std::vector<Prediction> ChainSimulator::predict(std::span<const PreparedRecord> records) {
  return predictions(records, readings(records));
}

/// Moment variance for white accelerometer noise of unit variance per sample.
void ChainSimulator::add_acceleration_noise(const PreparedRecord& record,
                                            std::span<double> variance) {
  // Both axes of an accelerometer have the same noise.
  const bool base = !record.acceleration.empty(), cross = !record.cross_acceleration.empty();
  const double n = static_cast<double>(record.n_evaluated);
  const std::vector<LinearPart>& lines = response_.lines(record);
  // The whisker's velocity relative to the wind is computed from the same noisy acceleration.
  const double drag = base && chain_.relative_wind.on ? drag_per_velocity(chain_, record) : 0.;
  for (std::size_t b = 0; b < variance.size(); ++b) {
    const std::size_t k = record.whole_line(b);
    const LinearPart& line = lines[k];
    Complex felt = 0.;
    if (drag != 0.) {
      const Complex s = record.line_s(k);
      if (gives_velocity(s)) felt = drag * line.wind / s;
    }
    if (base)
      variance[b] += n * std::norm((line.base - felt) * line.sensor) * record.bin_noise_share[b];
    if (cross) variance[b] += n * std::norm(line.cross * line.sensor);
  }
}

std::vector<RecordNuisance> ChainSimulator::unknowns_of(const PreparedRecord& record) {
  std::vector<RecordNuisance> out;
  const double evaluated_s = static_cast<double>(record.n_evaluated) / record.sampling_rate_hz;
  if (chain_.ramp_variance_rate > 0.)
    out.push_back(
        unknown_ramp(chain_.ramp_variance_rate * evaluated_s, record.n_evaluated, record.n_bins()));
  const auto add_wave = [&](const double variance, const Complex pole, const bool of_start) {
    if (!(variance > 0.)) return;
    for (RecordNuisance& part : unknown_wave(variance, pole / record.sampling_rate_hz,
                                             record.n_evaluated, record.n_bins())) {
      part.of_start = of_start;
      out.push_back(std::move(part));
    }
  };
  for (const Tone& tone : chain_.tones)
    add_wave(0.5 * tone.amplitude * tone.amplitude, {0., 2. * std::numbers::pi * tone.frequency_hz},
             false);
  if (response_.joint() && record.first > 0) {
    const Complex pole = pole_of(*response_.joint());
    if (pole.real() < 0.) add_wave(variance_of_start(record, pole), pole, true);
  }
  const double age = chain_.new_sample_share * record.unknown_age_s;
  if (age > 0.) {
    const std::vector<LinearPart>& lines = response_.lines(record);
    // exp(s t) to second order; the mean of t^4 of a uniform t is 1.8 squares of its variance.
    std::vector<Complex> first(record.n_samples / 2 + 1), second(first.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      const Complex s = record.line_s(k);
      first[k] = s * lines[k].base * lines[k].sensor * reading_of_source(chain_, record, k);
      second[k] = 0.5 * s * first[k];
    }
    out.push_back({age * age, bins_of_lines(record, first)});
    out.push_back({1.8 * std::pow(age, 4), bins_of_lines(record, second)});
  }
  return out;
}

Prediction ChainSimulator::with_noise(const PreparedRecord& record, std::vector<Complex> mean) {
  Prediction prediction;
  prediction.mean = std::move(mean);
  const std::size_t n_bins = record.n_bins();
  const double n = static_cast<double>(record.n_evaluated);
  prediction.moment_noise.assign(n_bins, n);
  prediction.acceleration_noise.assign(n_bins, 0.);
  if (record.is_response()) {
    for (std::size_t b = 0; b < n_bins; ++b)
      prediction.moment_noise[b] *= record.sines.noise_share[b];
    prediction.process_noise.assign(n_bins, 0.);
    if (const auto found = sweeps_.find(record.number); found != sweeps_.end())
      prediction.sweep = found->second;
    return prediction;
  }
  paint(prediction.moment_noise, record.colours.moment, record);
  if (!record.is_still()) {
    add_acceleration_noise(record, prediction.acceleration_noise);
    paint(prediction.acceleration_noise, record.colours.acceleration, record);
  }
  prediction.process_noise.assign(n_bins, 0.);
  prediction.unknowns = unknowns_of(record);
  if (!chain_.noise.empty()) {
    const RecordView view{
        .base = record.excitation.base,
        .wind = record.excitation.wind,
        .sampling_rate_hz = record.sampling_rate_hz,
        .n_samples = record.n_evaluated,
        .wind_speed = record.wind.empty()
                          ? std::span<const double>{}
                          : std::span(record.wind).subspan(record.first, record.n_evaluated),
        .wind_response = [&](std::size_t k) {
          const LinearPart& line = response_.lines(record)[record.whole_line(k - 1)];
          return line.wind * line.sensor;
        }};
    for (const NoiseSource& source : chain_.noise) source(view, prediction.process_noise);
  }
  return prediction;
}

std::vector<double> own_noise(const Prediction& prediction) {
  std::vector<double> out = prediction.process_noise;
  for (const RecordNuisance& unknown : prediction.unknowns)
    for (std::size_t b = 0; b < out.size() && !unknown.of_start; ++b)
      out[b] += unknown.variance * std::norm(unknown.shape[b]);
  return out;
}

/// The chains from the first one on that are predicted at a time; returns the next one.
std::size_t ChainSimulator::predict_group(const std::span<const Chain> chains,
                                          const std::size_t first,
                                          const std::span<const PreparedRecord> records,
                                          const std::span<const Prediction> near,
                                          const PredictionUser& use) {
  constexpr std::size_t n_together = 4;  // more exceed the caches
  const auto group = chains.subspan(first, std::min(n_together, chains.size() - first));
  std::vector<ChainSimulator> simulators(group.begin(), group.end());
  std::vector<Begun> begun;
  std::vector<DynamicTask> tasks;
  for (ChainSimulator& simulator : simulators) {
    begun.push_back(simulator.begin(records));
    tasks.push_back(std::move(begun.back().task));
  }
  const auto dynamic = dynamic_parts(tasks);
  for (std::size_t i = 0; i < simulators.size(); ++i)
    use(first + i,
        simulators[i].predictions(
            records, simulators[i].finish(records, std::move(begun[i]), dynamic[i], near)));
  return first + group.size();
}

void predict_together(const std::span<const Chain> chains,
                      const std::span<const PreparedRecord> records,
                      const std::span<const Prediction> near, const PredictionUser& use) {
  for (std::size_t first = 0; first < chains.size();)
    first = ChainSimulator::predict_group(chains, first, records, near, use);
}

Prediction simulate(const Chain& chain, const PreparedRecord& record) {
  return std::move(ChainSimulator(chain).predict({&record, 1}).front());
}

std::vector<Complex> simulate_mean(const Chain& chain, const PreparedRecord& record) {
  return std::move(ChainSimulator(chain).means({&record, 1}).front());
}

}  // namespace vibrissa::diagnosis
