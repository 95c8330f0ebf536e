#include "diagnosis/planning/planned_records.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/records/spectrum.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;

/// A channel's samples; empty when the channel is missing or zero at all samples.
std::vector<double> moving_channel(const signals::Record& record, const std::string& name) {
  if (!record.has(name)) return {};
  const auto x = record.channel(name);
  if (std::all_of(x.begin(), x.end(), [](double value) { return value == 0.; })) return {};
  return {x.begin(), x.end()};
}

/// Sum of unit sines at the frequencies k / n of the sampling rate, with random phases.
std::vector<double> lines_of(std::size_t n, const std::vector<std::size_t>& lines, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi);
  std::vector<Complex> spectrum(n / 2 + 1, 0.);
  for (const std::size_t k : lines)
    spectrum[k] = std::polar(0.5 * static_cast<double>(n), phase(random));
  return samples_of(spectrum, n);
}

using Inputs = std::vector<PlannedInput>;

constexpr double usual_level = 4., usual_wind = 2.;  // m/s^2 rms, m/s

double level_of(const PlannedInput& input) {
  return input.acceleration.empty() ? 0. : std::sqrt(mean_square(input.acceleration));
}

/// The strongest planned base motion without wind; a multisine when there is none.
PlannedInput strongest_base(Inputs planned) {
  const double rate_hz = planned.front().sampling_rate_hz;
  std::erase_if(planned, [](const PlannedInput& input) {
    return !input.wind.empty() || input.acceleration.empty();
  });
  if (planned.empty()) return multisine_input("base", 4., 0.25 * rate_hz, usual_level, rate_hz);
  return *std::ranges::max_element(planned, {}, level_of);
}

Inputs level_ladder(const PlannedInput& base) {
  Inputs out;
  for (const double factor : {0.25, 0.5, 1., 2.}) {
    out.push_back(base);
    out.back().name = "level_" + std::to_string(out.size());
    for (std::vector<double>* x : {&out.back().acceleration, &out.back().cross_acceleration})
      for (double& value : *x) value *= factor;
  }
  return out;
}

Inputs wind_ladder(const PlannedInput& base) {
  const double rate_hz = base.sampling_rate_hz;
  Inputs out;
  for (const int speed : {1, 2, 3, 4}) {
    out.push_back(gust_input("wind_" + std::to_string(speed) + "_m_s", speed,
                             static_cast<double>(base.n_samples) / rate_hz, rate_hz));
    PlannedInput both = out.back();
    both.name += "_base";
    both.acceleration = base.acceleration;
    both.acceleration.resize(both.n_samples, 0.);
    out.push_back(std::move(both));
  }
  return out;
}

PlannedInput steady_wind(const double rate_hz) {
  PlannedInput out = quiet_input(60., rate_hz);
  out.name = "steady_wind";
  out.wind.assign(out.n_samples, usual_wind);
  return out;
}

PlannedInput at_twice_the_rate(PlannedInput out) {
  constexpr std::size_t factor = 2;
  out.name = "other_rate";
  for (std::vector<double>* x : {&out.acceleration, &out.cross_acceleration})
    if (!x->empty()) *x = upsampled(spectrum_of(*x), out.n_samples, factor);
  out.sampling_rate_hz *= static_cast<double>(factor);
  out.n_samples *= factor;
  out.period_samples *= factor;
  return out;
}

}  // namespace

ChannelNoise usual_noise() {
  return {.moment_n_m = 1e-6, .acceleration_m_s2 = usual_acceleration_noise};
}

std::vector<PlannedInput> inputs_of(const NominalModel& nominal, const signals::Dataset& dataset) {
  std::vector<PlannedInput> out;
  for (const signals::DatasetRecord& entry : dataset.records) {
    if (entry.split != signals::Split::fit || !is_comparable(nominal, entry)) continue;
    const signals::Record& record = entry.record;
    PlannedInput input{.name = entry.name,
                       .sampling_rate_hz = record.sampling_rate_hz(),
                       .n_samples = record.n_samples(),
                       .cross_acceleration = moving_channel(record, channel::cross_acceleration),
                       .period_samples = entry.period_samples};
    if (entry.excitation.base)
      input.acceleration = moving_channel(record, channel::base_acceleration);
    if (entry.excitation.wind) input.wind = moving_channel(record, channel::wind_speed);
    out.push_back(std::move(input));
  }
  if (std::ranges::none_of(out, [](const PlannedInput& input) {
        return !input.acceleration.empty() || !input.wind.empty();
      }))
    throw signals::UserError(
        "no record of the planned dataset has an excitation that the simulation includes: give a "
        "fit record with excitation \"base\" or \"wind\"");
  return out;
}

std::vector<PlannedInput> usual_inputs(const NominalModel& nominal, const double rate_hz) {
  std::vector<PlannedInput> out;
  if (nominal.has_base)
    for (const auto& [name, level] :
         {std::pair<std::string, double>{"base_low", 1.}, {"base_high", 4.}})
      out.push_back(multisine_input(name, 4., 0.25 * rate_hz, level, rate_hz));
  if (nominal.has_wind) out.push_back(gust_input("wind", 2., 10., rate_hz));
  return out;
}

PlannedInput quiet_input(const double duration_s, const double rate_hz) {
  return {.name = "quiet",
          .sampling_rate_hz = rate_hz,
          .n_samples = fast_length(static_cast<std::size_t>(duration_s * rate_hz))};
}

PlannedInput multisine_input(const std::string& name, const double low_hz, const double high_hz,
                             const double level, const double rate_hz) {
  constexpr std::size_t period = 2048;
  std::vector<std::size_t> lines;
  for (std::size_t k = 1; k < period / 2; k += 2) {
    const double f = rate_hz * static_cast<double>(k) / static_cast<double>(period);
    if (f >= low_hz && f <= high_hz && (k / 2) % 4 != 1) lines.push_back(k);
  }
  std::vector<double> once = lines_of(period, lines, 3);
  const double scale = level / std::sqrt(mean_square(once));
  for (double& value : once) value *= scale;
  PlannedInput out{.name = name,
                   .sampling_rate_hz = rate_hz,
                   .n_samples = 2 * period,
                   .acceleration = once,
                   .period_samples = period};
  out.acceleration.insert(out.acceleration.end(), once.begin(), once.end());
  return out;
}

PlannedInput gust_input(const std::string& name, const double mean_m_s, const double duration_s,
                        const double rate_hz) {
  constexpr double lowest_hz = 0.1, highest_hz = 40., ratio = 1.5, gusts = 0.25;
  const std::size_t n = fast_length(static_cast<std::size_t>(duration_s * rate_hz));
  std::vector<std::size_t> lines;
  for (double f = lowest_hz; f < std::min(highest_hz, 0.4 * rate_hz); f *= ratio) {
    const auto k = static_cast<std::size_t>(std::lround(f * static_cast<double>(n) / rate_hz));
    if (k > 0 && (lines.empty() || k != lines.back())) lines.push_back(k);
  }
  PlannedInput out{.name = name, .sampling_rate_hz = rate_hz, .n_samples = n};
  out.wind = lines_of(n, lines, 5);
  const double scale = gusts * mean_m_s / std::sqrt(mean_square(out.wind));
  for (double& u : out.wind) u = mean_m_s + scale * u;
  return out;
}

signals::Dataset planned_dataset(const NominalModel& nominal,
                                 const std::vector<PlannedInput>& inputs,
                                 const ChannelNoise& noise) {
  std::mt19937 random(20240611);
  std::normal_distribution<double> normal;
  const auto with_noise = [&](std::vector<double> x, const std::size_t n, const double deviation) {
    x.resize(n, 0.);
    for (double& value : x) value += deviation * normal(random);
    return x;
  };
  signals::Dataset out;
  for (const PlannedInput& input : inputs) {
    const std::size_t n = input.n_samples;
    signals::Record record(input.sampling_rate_hz, n);
    record.set_channel(channel::base_acceleration,
                       with_noise(input.acceleration, n, noise.acceleration_m_s2));
    if (!input.cross_acceleration.empty())
      record.set_channel(channel::cross_acceleration,
                         with_noise(input.cross_acceleration, n, noise.acceleration_m_s2));
    const std::vector<Complex> moment =
        nominal_moment(nominal, n, input.sampling_rate_hz, input.acceleration, input.wind);
    record.set_channel(channel::base_moment,
                       with_noise(samples_of(moment, n), n, noise.moment_n_m));
    if (!input.wind.empty()) record.set_channel(channel::wind_speed, input.wind);
    out.records.push_back({input.name,
                           std::move(record),
                           {!input.acceleration.empty(), !input.wind.empty()},
                           input.period_samples,
                           signals::Split::fit,
                           nominal.readout});
  }
  return out;
}

std::optional<Inputs> added_inputs(const std::string& entry, const NominalModel& nominal,
                                   const Inputs& planned) {
  const double rate_hz = planned.front().sampling_rate_hz;
  if (entry == "quiet_record") return Inputs{quiet_input(60., rate_hz)};
  if (nominal.has_wind && entry == "steady_wind") return Inputs{steady_wind(rate_hz)};
  if (!nominal.has_base) return std::nullopt;
  const PlannedInput base = strongest_base(planned);
  const double same_hz = base.sampling_rate_hz;
  if (entry == "level_ladder") return level_ladder(base);
  if (entry == "wide_band")
    return Inputs{multisine_input(entry, 1., 0.45 * same_hz, level_of(base), same_hz)};
  if (entry == "other_sampling_rate") return Inputs{at_twice_the_rate(base)};
  if (nominal.has_wind && entry == "wind_ladder") return wind_ladder(base);
  return std::nullopt;
}

}  // namespace vibrissa::diagnosis
