#include "signals/excitation/swept_sine.h"

#include <cmath>
#include <numbers>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals {

namespace {

void check_sweep(const SweptSine& sweep, double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("swept sine: sampling rate " + to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
  for (const double f : {sweep.low_hz, sweep.high_hz})
    if (!(f > 0. && f < 0.5 * sampling_rate_hz))
      throw UserError("swept sine: frequency " + to_text(f) +
                      " Hz must be above 0 and below half the sampling rate of " +
                      to_text(sampling_rate_hz) + " Hz");
  if (!(sweep.peak >= 0.) || !std::isfinite(sweep.peak))
    throw UserError("swept sine: peak " + to_text(sweep.peak) + " is negative or not finite");
  if (sweep.n_samples == 0 || sweep.fade_samples > sweep.n_samples / 2)
    throw UserError("swept sine: " + std::to_string(sweep.n_samples) +
                    " samples are too few for two fades of " + std::to_string(sweep.fade_samples));
}

double cycles(const SweptSine& sweep, double time_s, double duration_s) {
  const double share = time_s / duration_s;
  if (sweep.law == SweepLaw::linear)
    return time_s * (sweep.low_hz + 0.5 * (sweep.high_hz - sweep.low_hz) * share);
  const double octaves = std::log(sweep.high_hz / sweep.low_hz);
  if (octaves == 0.) return sweep.low_hz * time_s;
  return sweep.low_hz * duration_s / octaves * std::expm1(octaves * share);
}

}  // namespace

std::vector<double> sample(const SweptSine& sweep, double sampling_rate_hz) {
  check_sweep(sweep, sampling_rate_hz);
  constexpr double pi = std::numbers::pi;
  const double duration_s = static_cast<double>(sweep.n_samples) / sampling_rate_hz;
  std::vector<double> x(sweep.n_samples);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double turns = cycles(sweep, static_cast<double>(i) / sampling_rate_hz, duration_s);
    x[i] = sweep.peak * std::sin(2. * pi * std::fmod(turns, 1.));
  }
  for (std::size_t i = 0; i < sweep.fade_samples; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(sweep.fade_samples);
    const double weight = std::pow(std::sin(0.5 * pi * share), 2);
    x[i] *= weight;
    x[x.size() - 1 - i] *= weight;
  }
  return x;
}

}  // namespace vibrissa::signals
