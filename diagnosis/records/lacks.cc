#include <algorithm>
#include <cmath>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {
namespace {

/// Does the effect change anything except the joint of the first mode?
bool acts_without_modes(const Effect& effect) {
  const Chain chain = probe(effect, NominalModel{});
  return !(chain.reference.empty() && chain.mount.empty() && chain.parallel.empty() &&
           chain.wind.empty() && chain.drag_factor == 1. && chain.feedthrough.empty() &&
           chain.cross.empty() && chain.readout.empty() && chain.sensor.empty() &&
           chain.clock_rate_error == 0. && chain.new_sample_share == 0. &&
           chain.reference_variance == 0. && chain.noise.empty() &&
           chain.ramp_variance_rate == 0. && chain.tones.empty());
}

/// Does the effect change anything in a steady state under a sine?
bool acts_on_responses(const Effect& effect) {
  const Chain chain = probe(effect, NominalModel{.modes = {StructuralMode{.frequency_rad_s = 1.}}});
  return chain.clock_rate_error == 0. && chain.new_sample_share == 0. &&
         chain.reference_variance == 0. && chain.noise.empty() && chain.ramp_variance_rate == 0. &&
         chain.tones.empty();
}

double moved_seconds(const Experiment& experiment) {
  double sum = 0.;
  for (const PreparedRecord& record : experiment.records)
    if (record.excitation.base || record.excitation.wind)
      sum += static_cast<double>(record.n_samples) / record.sampling_rate_hz;
  return sum;
}

}  // namespace

std::vector<Lack> lacks(const Experiment& experiment, const Effect& effect) {
  const Needs& needs = effect.needs;
  std::vector<Lack> out;
  if (needs.base && !experiment.has_base) out.push_back(Lack::base);
  if (needs.wind && !experiment.has_wind) out.push_back(Lack::wind);
  if (needs.cross && !experiment.has_cross) out.push_back(Lack::cross);
  if (needs.repeats && !experiment.has_repeats) out.push_back(Lack::repeats);
  if (experiment.nominal.modes.empty() && !acts_without_modes(effect)) out.push_back(Lack::modes);
  if (std::ranges::all_of(experiment.records, &PreparedRecord::is_response) &&
      !acts_on_responses(effect))
    out.push_back(Lack::time);
  if (needs.moved_s > 0. && moved_seconds(experiment) <= needs.moved_s)
    out.push_back(Lack::duration);
  const double highest = std::log(experiment.scales.moved_band_hz);
  if (std::ranges::any_of(effect.parameters, [&](const Parameter& parameter) {
        return parameter.in_moved_band && highest < parameter.prior.low;
      }))
    out.push_back(Lack::band);
  return out;
}

bool shows(const Experiment& experiment, const Effect& effect) {
  return lacks(experiment, effect).empty();
}

}  // namespace vibrissa::diagnosis
