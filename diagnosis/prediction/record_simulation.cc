#include "diagnosis/prediction/record_simulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// Number of samples after which transients have decayed: length of the circular continuation.
std::size_t tail_length(const NominalModel& nominal, double rate_hz) {
  constexpr double n_time_constants = 14.;
  constexpr std::size_t least = 128;
  return std::max(least, nominal.decay_samples(n_time_constants, rate_hz));
}

/// Appends a smooth transition from the last value to the first, which is then held.
void close_circle(std::vector<double>& x, std::size_t n) {
  const double from = x.back(), to = x.front();
  const std::size_t n_samples = x.size(), n_turn = (n - n_samples) / 4;
  for (std::size_t i = 0; n_samples + i < n; ++i) {
    const double share = i < n_turn
                             ? 0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(i + 1) /
                                                    static_cast<double>(n_turn))
                             : 1.;
    x.push_back(from + share * (to - from));
  }
}

}  // namespace

std::vector<double> simulate_moment(const UpdatedModel& model, const signals::Record& inputs,
                                    const Start start) {
  namespace channel = signals::channel;
  const bool base = model.nominal.has_base && inputs.has(channel::base_acceleration);
  const bool wind = model.nominal.has_wind && inputs.has(channel::wind_speed);
  if (!base && !wind)
    throw signals::UserError("the record has no input of the model: it needs " +
                             std::string(model.nominal.has_base ? channel::base_acceleration : "") +
                             (model.nominal.has_base && model.nominal.has_wind ? " or " : "") +
                             std::string(model.nominal.has_wind ? channel::wind_speed : ""));
  PreparedRecord record;
  record.excitation = {.base = base, .wind = wind};
  record.readout = model.nominal.readout;
  record.sampling_rate_hz = inputs.sampling_rate_hz();
  record.periodic = start == Start::periodic && inputs.n_samples() % 2 == 0;
  record.n_samples = inputs.n_samples();
  if (!record.periodic) {
    record.n_samples += tail_length(model.nominal, record.sampling_rate_hz);
    while (fast_length(record.n_samples) != record.n_samples) ++record.n_samples;
  }
  record.n_evaluated = record.n_samples;
  const auto continued = [&](const std::string& name) {
    const auto values = inputs.channel(name);
    std::vector<double> x(values.begin(), values.end());
    close_circle(x, record.n_samples);
    return x;
  };
  if (base) record.acceleration = spectrum_of(continued(channel::base_acceleration));
  if (inputs.has(channel::cross_acceleration))
    record.cross_acceleration = spectrum_of(continued(channel::cross_acceleration));
  if (wind) record.wind = continued(channel::wind_speed);
  const Chain chain = model.chain();
  std::vector<double> moment = ChainSimulator(chain).samples(record);
  moment.resize(inputs.n_samples());
  return moment;
}

std::vector<double> simulate_vibration(const UpdatedModel& model, const signals::Record& inputs) {
  signals::Record base(inputs.sampling_rate_hz(), inputs.n_samples());
  for (const std::string& name :
       {signals::channel::base_acceleration, signals::channel::cross_acceleration})
    if (inputs.has(name)) {
      const auto values = inputs.channel(name);
      base.set_channel(name, {values.begin(), values.end()});
    }
  return simulate_moment(model, base);
}

std::vector<double> subtract_vibration(const UpdatedModel& model, const signals::Record& record) {
  const auto measured = record.channel(signals::channel::base_moment);
  std::vector<double> left = simulate_vibration(model, record);
  std::ranges::transform(measured, left, left.begin(), std::minus<>());
  return left;
}

}  // namespace vibrissa::diagnosis
