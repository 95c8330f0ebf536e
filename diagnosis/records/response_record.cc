#include "diagnosis/records/response_record.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "signals/base/median.h"

namespace vibrissa::diagnosis {
namespace {

/// Derivative of the deflection at angular frequency w that the quantity is.
Complex per_deflection(const signals::ResponseQuantity quantity, const double w) {
  using enum signals::ResponseQuantity;
  return quantity == velocity ? Complex(0., w) : quantity == acceleration ? Complex(-w * w) : 1.;
}

/// Every second, third ... line of a response with more lines than this: a line costs as much time
/// as many samples of a record.
signals::DatasetResponse thinned(const signals::DatasetResponse& entry) {
  constexpr std::size_t most_lines = 256;
  const std::size_t step = (entry.frequency_hz.size() + most_lines - 1) / most_lines;
  signals::DatasetResponse out = entry;
  const auto thin = [&](auto& values) {
    for (std::size_t i = 0; i * step < values.size(); ++i) values[i] = values[i * step];
    values.resize((values.size() + step - 1) / step);
  };
  thin(out.frequency_hz);
  thin(out.value);
  thin(out.standard_deviation);
  thin(out.level_m_s2);
  return out;
}

double angular(const double hz) {
  return 2. * std::numbers::pi * hz;
}

}  // namespace

signals::Readout readout_of(const signals::ResponseQuantity quantity) {
  return quantity == signals::ResponseQuantity::moment ? signals::Readout::moment
                                                       : signals::Readout::rotation;
}

std::vector<Complex> as_deflection(const signals::DatasetResponse& entry) {
  std::vector<Complex> out = entry.value;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] /= per_deflection(entry.quantity, angular(entry.frequency_hz[i]));
  return out;
}

bool is_comparable(const NominalModel& nominal, const signals::DatasetResponse& entry) {
  return is_simulated(entry.setup) && nominal.has_base;
}

PreparedRecord prepare_response(const signals::DatasetResponse& measured,
                                const std::size_t number) {
  const signals::DatasetResponse entry = thinned(measured);
  const std::size_t n_lines = entry.frequency_hz.size(), n = 2 * (n_lines + 1);
  const double half = 0.5 * static_cast<double>(n),
               per_amplitude = half / std::sqrt(static_cast<double>(n_lines)),
               axial = std::cos(entry.setup.rotation_deg * std::numbers::pi / 180.);
  PreparedRecord out{.name = entry.name,
                     .excitation = {.base = true},
                     .number = number,
                     .readout = readout_of(entry.quantity),
                     .magnet = entry.setup.magnet,
                     .sampling_rate_hz = 2. * entry.frequency_hz.back(),
                     .n_samples = n,
                     .n_evaluated = n,
                     .acceleration = std::vector<Complex>(n_lines + 2, 0.),
                     .noise_share = std::vector<double>(n_lines + 2, 0.),
                     .bin_noise_share = std::vector<double>(n_lines, 0.),
                     .sines = {.frequency_hz = entry.frequency_hz,
                               .direction = entry.direction,
                               .per_amplitude = per_amplitude,
                               .phase_is_known = entry.phase_offset_is_known},
                     .moment = as_deflection(entry)};
  for (std::size_t i = 0; i < n_lines; ++i) {
    out.acceleration[i + 1] = per_amplitude * axial * entry.level_m_s2[i];
    out.moment[i] *= per_amplitude;
    const double deviation =
        per_amplitude * entry.standard_deviation[i] /
        std::abs(per_deflection(entry.quantity, angular(entry.frequency_hz[i])));
    out.sines.noise_share.push_back(deviation * deviation / static_cast<double>(n));
  }
  return out;
}

void add_responses(Experiment& experiment, const signals::Dataset& dataset,
                   const signals::Split split) {
  std::vector<double> variances;
  for (std::size_t i = 0; i < dataset.responses.size(); ++i) {
    const signals::DatasetResponse& entry = dataset.responses[i];
    if (entry.split != split || !is_comparable(experiment.nominal, entry)) continue;
    experiment.records.push_back(prepare_response(entry, dataset.records.size() + i));
    const PreparedRecord& record = experiment.records.back();
    experiment.has_base |= record.magnet;
    variances.insert(variances.end(), record.sines.noise_share.begin(),
                     record.sines.noise_share.end());
  }
  if (dataset.records.empty() && !variances.empty())
    experiment.moment_noise = std::sqrt(signals::median(std::move(variances)));
}

void share_noise(Experiment& experiment) {
  const double variance = experiment.moment_noise * experiment.moment_noise;
  for (PreparedRecord& record : experiment.records)
    for (double& share : record.sines.noise_share) share /= variance;
}

}  // namespace vibrissa::diagnosis
