#include "diagnosis/records/experiment.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include "diagnosis/records/response_record.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/error.h"
#include "signals/record/whole_transient.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

/// Number of time constants of the first mode after which transients have decayed.
constexpr double n_time_constants = 7.;
/// Samples at the end of an aperiodic record that its circular continuation disturbs.
constexpr std::size_t end_margin = 24;
constexpr std::size_t fewest_evaluated = 128;

bool is_periodic(const DatasetRecord& entry) {
  return entry.period_samples > 0 && entry.record.n_samples() % entry.period_samples == 0;
}

/// Samples at both ends that are not evaluated; nothing where the whole record is.
std::optional<std::size_t> skipped_samples(const NominalModel& nominal,
                                           const DatasetRecord& entry) {
  if (is_periodic(entry) || entry.excitation == signals::Excitation{}) return std::nullopt;
  if (!entry.excitation.wind && signals::is_whole_transient(entry.record)) return std::nullopt;
  return nominal.decay_samples(n_time_constants, entry.record.sampling_rate_hz()) + end_margin;
}

/// Averages whole periods in place: lines that are not multiples of 1/period become zero.
void average_periods(std::vector<Complex>& spectrum, std::size_t number) {
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    if (k % number != 0) spectrum[k] = 0.;
}

/// Excited harmonics by period length in samples. A harmonic that exceeds the noise in one record
/// counts as excited in all records.
using ExcitedHarmonics = std::map<std::size_t, std::vector<bool>>;

/// Without excitation a line exceeds this threshold with probability 1e-5.
bool stands_out(const Complex line, const double noise_power) {
  constexpr double least_ratio = 12.;
  return std::norm(line) > least_ratio * noise_power;
}

ExcitedHarmonics excited_harmonics(const signals::Dataset& dataset, signals::Split split,
                                   double noise) {
  ExcitedHarmonics excited;
  for (const DatasetRecord& entry : dataset.records) {
    const std::size_t period = entry.period_samples, n = entry.record.n_samples();
    if (entry.split != split || !entry.excitation.base || !is_periodic(entry) ||
        !entry.record.has(channel::base_acceleration))
      continue;
    const std::vector<Complex> spectrum =
        spectrum_of(entry.record.channel(channel::base_acceleration));
    std::vector<bool>& mask = excited.try_emplace(period, period / 2 + 1, false).first->second;
    for (std::size_t h = 1; h < mask.size(); ++h)
      if (stands_out(spectrum[h * n_periods(entry)], static_cast<double>(n) * noise * noise))
        mask[h] = true;
  }
  return excited;
}

/// Period of the excitation in samples, for a record without a stated period: the strong lines have
/// a common divisor. Nothing when it is not periodic.
std::optional<std::size_t> period_of_drive(const DatasetRecord& entry, double noise) {
  if (!entry.excitation.base || !entry.record.has(channel::base_acceleration)) return std::nullopt;
  const std::vector<Complex> a = spectrum_of(entry.record.channel(channel::base_acceleration));
  const std::size_t n = entry.record.n_samples();
  std::size_t divisor = 0;
  for (std::size_t k = 1; k < a.size(); ++k)
    if (stands_out(a[k], static_cast<double>(n) * noise * noise)) divisor = std::gcd(divisor, k);
  if (divisor < 2 || n % divisor != 0) return std::nullopt;
  return n / divisor;
}

/// Length of the longest part of at most n samples: whole periods of the excitation (no leakage),
/// otherwise a length with a fast transform.
std::size_t evaluated_length(std::size_t n, std::optional<std::size_t> period) {
  if (!period) return fast_length(n);
  const std::size_t even = *period % 2 == 0 ? *period : 2 * *period;
  return n < even ? fast_length(n) : n - n % even;
}

/// Wiener gain P / (P + noise) of each chosen line. P is taken from the line itself when it exceeds
/// the noise, otherwise from the mean power of the neighbouring weak lines (of all neighbouring
/// lines when most are strong, because a continuous spectrum also has weak lines).
std::vector<double> signal_share(const std::vector<Complex>& spectrum, double noise_power,
                                 const std::vector<std::size_t>& lines) {
  std::vector<double> share(spectrum.size(), 0.);
  constexpr std::size_t reach = 10;
  std::vector<bool> is_tone(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    is_tone[i] = stands_out(spectrum[lines[i]], noise_power);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t low = i < reach ? 0 : i - reach, high = std::min(lines.size(), i + reach + 1);
    double tones = 0., others = 0., n_tones = 0., n_others = 0.;
    for (std::size_t j = low; j < high; ++j) {
      (is_tone[j] ? tones : others) += std::norm(spectrum[lines[j]]);
      (is_tone[j] ? n_tones : n_others) += 1.;
    }
    const double power = is_tone[i]           ? std::norm(spectrum[lines[i]])
                         : n_tones > n_others ? (tones + others) / (n_tones + n_others)
                                              : others / n_others;
    if (power > noise_power) share[lines[i]] = 1. - noise_power / power;
  }
  return share;
}

std::vector<std::size_t> driven_lines(const PreparedRecord& record, const DatasetRecord& entry,
                                      const ExcitedHarmonics& excited) {
  std::vector<std::size_t> lines;
  const auto found = excited.find(entry.period_samples);
  const std::size_t step = n_periods(entry);
  for (std::size_t k = 1; k <= record.n_samples / 2; ++k)
    if (!record.periodic || (k % step == 0 && found != excited.end() && found->second[k / step]))
      lines.push_back(k);
  return lines;
}

/// Accelerations in the frame of a sensor that is rotated about its axis while the accelerometer is
/// not: in the measured plane, and across it.
struct SensorFrame {
  std::vector<double> axial, cross;  // empty: not measured
};

SensorFrame in_sensor_frame(const DatasetRecord& entry) {
  const auto values = [&](const std::string& name) {
    if (!entry.record.has(name)) return std::vector<double>{};
    const auto x = entry.record.channel(name);
    return std::vector<double>(x.begin(), x.end());
  };
  SensorFrame out{values(channel::base_acceleration), values(channel::cross_acceleration)};
  if (entry.setup.rotation_deg == 0. || out.axial.empty()) return out;
  const double angle = entry.setup.rotation_deg * std::numbers::pi / 180.;
  const double c = std::cos(angle), s = std::sin(angle);
  out.cross.resize(out.axial.size(), 0.);
  for (std::size_t i = 0; i < out.axial.size(); ++i) {
    const double a = out.axial[i], b = out.cross[i];
    out.axial[i] = c * a + s * b;
    out.cross[i] = c * b - s * a;
  }
  return out;
}

void prepare_acceleration(PreparedRecord& out, const DatasetRecord& entry,
                          const std::span<const double> reading, const double noise,
                          const ExcitedHarmonics& excited, const InputNoise treatment) {
  out.acceleration = spectrum_of(reading);
  const NoiseLines noise_of = noise_lines(reading, out.sampling_rate_hz, entry.excitation.base);
  if (entry.excitation.base && noise_of.of_source) {
    out.source_acceleration = noise_of.spectrum;
    out.unknown_age_s = noise_of.age_range / std::sqrt(12.) / out.sampling_rate_hz;
  }
  const double n = static_cast<double>(out.n_samples);
  if (treatment == InputNoise::as_measured) {
    out.noise_share.assign(out.acceleration.size(), 1.);
    return;
  }
  for (std::size_t k = 1; k + 1 < noise_of.end; ++k)
    if (!entry.excitation.base || k % n_periods(entry) != 0) {
      out.acceleration_noise_power += std::norm(noise_of.spectrum[k]);
      ++out.n_acceleration_noise;
    }
  if (!entry.excitation.base) {
    out.acceleration.assign(out.acceleration.size(), 0.);
    out.noise_share.assign(out.acceleration.size(), 0.);
    return;
  }
  average_periods(out.acceleration, n_periods(entry));
  average_periods(out.source_acceleration, n_periods(entry));
  const double noise_power = n * noise * noise;
  out.noise_share = signal_share(out.acceleration, noise_power, driven_lines(out, entry, excited));
  for (std::size_t k = 0; k < out.acceleration.size(); ++k) {
    const double share = out.noise_share[k];
    // The Wiener gain removes signal from a line that is far above its neighbours (noise alone:
    // once in twenty). This loss is added to the remaining noise.
    const double lost = std::max(0., std::norm(out.acceleration[k]) / noise_power - 3.);
    out.noise_share[k] = std::max(share, share * share + (1. - share) * (1. - share) * lost);
    out.acceleration[k] *= share;
    if (!out.source_acceleration.empty()) out.source_acceleration[k] *= share;
  }
}

PreparedRecord prepare_record(const NominalModel& nominal, const DatasetRecord& entry,
                              std::size_t number, double acceleration_noise,
                              const ExcitedHarmonics& excited, const InputNoise treatment) {
  PreparedRecord out{.name = entry.name,
                     .excitation = entry.excitation,
                     .number = number,
                     .readout = entry.readout,
                     .magnet = entry.setup.magnet,
                     .sampling_rate_hz = entry.record.sampling_rate_hz(),
                     .clock_start_s = entry.clock_start_s,
                     .n_samples = entry.record.n_samples(),
                     .periodic = is_periodic(entry)};
  if (const std::optional<std::size_t> skip = skipped_samples(nominal, entry)) {
    assert(out.n_samples >= *skip + fewest_evaluated);
    out.first = *skip - end_margin;
    out.n_evaluated =
        evaluated_length(out.n_samples - *skip, period_of_drive(entry, acceleration_noise));
  } else {
    out.n_evaluated = out.n_samples - out.n_samples % 2;
  }
  const SensorFrame frame = in_sensor_frame(entry);
  if (!frame.axial.empty())
    prepare_acceleration(out, entry, frame.axial, acceleration_noise, excited, treatment);
  if (!out.noise_share.empty())
    out.bin_noise_share = share_at_bins(out.noise_share, out.n_samples, out.n_evaluated);
  if (!frame.cross.empty()) out.cross_acceleration = spectrum_of(frame.cross);
  if (entry.excitation.wind) {
    const auto wind = entry.record.channel(channel::wind_speed);
    out.wind.assign(wind.begin(), wind.end());
    out.wind_share = std::cos(entry.setup.rotation_deg * std::numbers::pi / 180.);
  }
  out.has_zero_inputs = out.cross_acceleration.empty() && total_power(out.acceleration) == 0.;
  out.moment = evaluated_bins(out, entry.record.channel(channel::base_moment));
  return out;
}

/// Scales::moved_band_hz.
double moved_band_hz(const Experiment& experiment) {
  constexpr double nearly_all = 0.99;
  double out = 0.;
  for (const PreparedRecord& record : experiment.records) {
    if (!record.excitation.base || record.acceleration.empty()) continue;
    std::vector<double> sum = powers(record.acceleration);
    std::partial_sum(sum.begin(), sum.end(), sum.begin());
    const auto line = std::ranges::lower_bound(sum, nearly_all * sum.back()) - sum.begin();
    out = std::max(out,
                   record.line_s(static_cast<std::size_t>(line)).imag() / (2. * std::numbers::pi));
  }
  return out;
}

Scales scales_of(const Experiment& experiment) {
  const NominalModel& nominal = experiment.nominal;
  Scales scales{.duration_s = 0.,
                .static_gain = std::abs(nominal.base_response(0.)),
                .moment_rms_n_m = 0.,
                .moved_band_hz = moved_band_hz(experiment)};
  double highest_rate_hz = 0.;
  for (const PreparedRecord& record : experiment.records) {
    highest_rate_hz = std::max(highest_rate_hz, record.sampling_rate_hz);
    scales.duration_s = std::max(scales.duration_s,
                                 static_cast<double>(record.n_samples) / record.sampling_rate_hz);
    scales.moment_rms_n_m =
        std::max(scales.moment_rms_n_m, std::sqrt(2. * total_power(record.moment)) /
                                            static_cast<double>(record.n_evaluated));
  }
  scales.joint_moment_n_m = 3. * scales.moment_rms_n_m;
  // Without a mode the logarithmic middle of the band is used.
  scales.first_mode_rad_s = !nominal.modes.empty() ? nominal.modes.front().frequency_rad_s
                                                   : 0.1 * std::numbers::pi * highest_rate_hz;
  return scales;
}

/// Why a record cannot be compared with the simulation; nothing where it can.
std::optional<std::string> why_not_comparable(const NominalModel& nominal,
                                              const DatasetRecord& entry) {
  if (!is_simulated(entry.setup)) return "its setup cannot be simulated";
  const std::size_t n = entry.record.n_samples(), fewest = fewest_samples(nominal, entry);
  if (n < fewest)
    return "it has " + std::to_string(n) + " samples and needs " + std::to_string(fewest) +
           ", because the first mode of the simulation decays slowly";
  if (entry.excitation.base && !entry.record.has(channel::base_acceleration))
    return "base_acceleration_m_s2 is not measured";
  if (entry.excitation.base && !nominal.has_base) return "the simulation tells no base response";
  if (entry.excitation.wind && !entry.record.has(channel::wind_speed))
    return "wind_speed_m_s is not measured";
  if (entry.excitation.wind && !nominal.has_wind) return "the simulation tells no wind response";
  return std::nullopt;
}

[[noreturn]] void refuse_all(const NominalModel& nominal, const signals::Dataset& dataset) {
  constexpr std::size_t n_listed = 3;
  std::string text = "no record can be compared with the simulation";
  std::size_t n = 0;
  for (const DatasetRecord& entry : dataset.records) {
    if (entry.split != signals::Split::fit || n == n_listed) continue;
    ++n;
    text += (n == 1 ? ": " : "; ") + entry.name + ": " +
            why_not_comparable(nominal, entry).value_or("neither base nor wind moves");
  }
  throw signals::UserError(text +
                           ". Give a fit record that is long enough and whose excitation is "
                           "measured and simulated");
}

}  // namespace

std::size_t fewest_samples(const NominalModel& nominal, const DatasetRecord& entry) {
  const std::optional<std::size_t> skip = skipped_samples(nominal, entry);
  return skip ? *skip + fewest_evaluated : 0;
}

bool is_simulated(const signals::BenchSetup& setup) {
  return setup.added_mass_kg == 0. && setup.stage == signals::Stage::free;
}

bool is_comparable(const NominalModel& nominal, const DatasetRecord& entry) {
  return !why_not_comparable(nominal, entry);
}

std::size_t PreparedRecord::block_length() const {
  constexpr double block_s = 0.25;
  if (is_response()) return std::max<std::size_t>(1, n_evaluated / 16);
  return std::max<std::size_t>(1,
                               static_cast<std::size_t>(std::lround(block_s * sampling_rate_hz)));
}

std::size_t PreparedRecord::whole_line(const std::size_t b) const {
  if (n_samples == n_evaluated) return b + 1;
  const double ratio = static_cast<double>(n_samples) / static_cast<double>(n_evaluated);
  return std::min(n_samples / 2,
                  static_cast<std::size_t>(std::lround(static_cast<double>(b + 1) * ratio)));
}

Complex PreparedRecord::line_s(const std::size_t k) const {
  if (is_response() && k > 0 && k <= n_bins())
    return {0., 2. * std::numbers::pi * sines.frequency_hz[k - 1]};
  return {0., 2. * std::numbers::pi * sampling_rate_hz * static_cast<double>(k) /
                  static_cast<double>(n_samples)};
}

std::vector<double> evaluated_samples(const PreparedRecord& record, std::span<const Complex> bins) {
  assert(bins.size() == record.n_bins());
  if (record.is_response()) {
    const double scale = std::sqrt(2. / static_cast<double>(record.n_evaluated));
    std::vector<double> parts;
    for (const Complex& bin : bins)
      parts.insert(parts.end(), {scale * bin.real(), scale * bin.imag()});
    return parts;
  }
  std::vector<Complex> whole(record.n_evaluated / 2 + 1, 0.);
  std::copy(bins.begin(), bins.end(), whole.begin() + 1);
  return samples_of(whole, record.n_evaluated);
}

std::vector<Complex> evaluated_bins(const PreparedRecord& record, std::span<const double> samples) {
  const std::vector<Complex> lines = spectrum_of(samples.subspan(record.first, record.n_evaluated));
  return {lines.begin() + 1, lines.end() - 1};
}

std::vector<Complex> bins_of_lines(const PreparedRecord& record,
                                   const std::vector<Complex>& whole) {
  if (record.n_evaluated == record.n_samples) return {whole.begin() + 1, whole.end() - 1};
  return evaluated_bins(record, samples_of(whole, record.n_samples));
}

Experiment prepare_experiment(const UpdatedModel& simulation, const signals::Dataset& dataset,
                              const signals::Split split, const InputNoise treatment) {
  Experiment experiment;
  const NominalModel& nominal = simulation.nominal;
  experiment.nominal = nominal;
  experiment.known = simulation.effects;
  const ChannelNoise noise = channel_noise(dataset);
  experiment.moment_noise = noise.moment_n_m;
  experiment.acceleration_noise = noise.acceleration_m_s2;
  experiment.acceleration_noise_is_measured = noise.acceleration_is_measured;
  const ExcitedHarmonics excited = excited_harmonics(dataset, split, noise.acceleration_m_s2);
  const ChannelColours colours = channel_colours(dataset);
  for (std::size_t i = 0; i < dataset.records.size(); ++i) {
    const DatasetRecord& entry = dataset.records[i];
    if (entry.split != split || !is_comparable(nominal, entry)) continue;
    experiment.records.push_back(
        prepare_record(nominal, entry, i, noise.acceleration_m_s2, excited, treatment));
    PreparedRecord& record = experiment.records.back();
    record.colours = colours;
    experiment.has_base |= entry.excitation.base && record.magnet;
    experiment.has_wind |= entry.excitation.wind && record.magnet;
    experiment.has_cross |= !record.cross_acceleration.empty();
    experiment.has_repeats |= !record.source_acceleration.empty();
  }
  add_responses(experiment, dataset, split);
  if (!experiment.has_base && !experiment.has_wind && split == signals::Split::fit)
    refuse_all(nominal, dataset);
  experiment.scales = scales_of(experiment);
  if (experiment.moment_noise <= 0.)
    experiment.moment_noise = 1e-3 * experiment.scales.moment_rms_n_m;
  if (experiment.acceleration_noise <= 0.) experiment.acceleration_noise = 1e-3;
  share_noise(experiment);
  return experiment;
}

}  // namespace vibrissa::diagnosis
