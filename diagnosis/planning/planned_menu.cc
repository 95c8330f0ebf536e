#include "diagnosis/planning/planned_menu.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

using Inputs = std::vector<PlannedInput>;

constexpr double usual_level = 4., usual_wind = 2.;  // m/s^2 rms, m/s

double level_of(const std::vector<double>& x) {
  double sum = 0.;
  for (const double value : x) sum += value * value;
  return x.empty() ? 0. : std::sqrt(sum / static_cast<double>(x.size()));
}

double rate_of(const Inputs& planned) {
  return planned.front().sampling_rate_hz;
}

/// The strongest planned base motion without wind; a multisine when there is none.
PlannedInput strongest_base(const Inputs& planned) {
  const PlannedInput* best = nullptr;
  for (const PlannedInput& input : planned)
    if (input.wind.empty() && !input.acceleration.empty() &&
        (best == nullptr || level_of(input.acceleration) > level_of(best->acceleration)))
      best = &input;
  if (best != nullptr) return *best;
  const double rate_hz = rate_of(planned);
  return multisine_input("base", 4., 0.25 * rate_hz, usual_level, rate_hz);
}

Inputs level_ladder(const Inputs& planned) {
  const PlannedInput base = strongest_base(planned);
  Inputs out;
  for (const double factor : {0.25, 0.5, 1., 2.}) {
    out.push_back(base);
    out.back().name = "level_" + std::to_string(out.size());
    for (std::vector<double>* x : {&out.back().acceleration, &out.back().cross_acceleration})
      for (double& value : *x) value *= factor;
  }
  return out;
}

Inputs wind_ladder(const Inputs& planned) {
  const PlannedInput base = strongest_base(planned);
  const double rate_hz = base.sampling_rate_hz;
  const double duration_s = static_cast<double>(base.n_samples) / rate_hz;
  Inputs out;
  for (const double speed : {1., 2., 3., 4.}) {
    const std::string name = "wind_" + std::to_string(static_cast<int>(speed)) + "_m_s";
    out.push_back(gust_input(name, speed, duration_s, rate_hz));
    PlannedInput both = out.back();
    both.name += "_base";
    both.acceleration = base.acceleration;
    both.acceleration.resize(both.n_samples, 0.);
    out.push_back(std::move(both));
  }
  return out;
}

Inputs steady_wind(const Inputs& planned) {
  PlannedInput out = quiet_input(60., rate_of(planned));
  out.name = "steady_wind";
  out.wind.assign(out.n_samples, usual_wind);
  return {out};
}

Inputs wide_band(const Inputs& planned) {
  const PlannedInput base = strongest_base(planned);
  const double rate_hz = base.sampling_rate_hz;
  return {multisine_input("wide_band", 1., 0.45 * rate_hz, level_of(base.acceleration), rate_hz)};
}

/// At twice the rate.
Inputs other_sampling_rate(const Inputs& planned) {
  constexpr std::size_t factor = 2;
  PlannedInput out = strongest_base(planned);
  out.name = "other_rate";
  for (std::vector<double>* x : {&out.acceleration, &out.cross_acceleration})
    if (!x->empty()) *x = upsampled(spectrum_of(*x), out.n_samples, factor);
  out.sampling_rate_hz *= static_cast<double>(factor);
  out.n_samples *= factor;
  out.period_samples *= factor;
  return {out};
}

}  // namespace

std::optional<Inputs> added_inputs(const std::string& entry, const NominalModel& nominal,
                                   const Inputs& planned) {
  if (nominal.has_base) {
    if (entry == "level_ladder") return level_ladder(planned);
    if (entry == "wide_band") return wide_band(planned);
    if (entry == "other_sampling_rate") return other_sampling_rate(planned);
  }
  if (nominal.has_wind && entry == "steady_wind") return steady_wind(planned);
  if (nominal.has_wind && nominal.has_base && entry == "wind_ladder") return wind_ladder(planned);
  if (entry == "quiet_record") return Inputs{quiet_input(60., rate_of(planned))};
  return std::nullopt;
}

}  // namespace vibrissa::diagnosis
