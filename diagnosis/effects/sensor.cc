#include <cmath>
#include <numbers>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// Starting values about the mains frequencies and their harmonics. Mains frequency varies by a
/// tenth of a hertz, and the step is small because long records resolve such differences, so basins
/// of attraction are narrow.
std::vector<std::vector<double>> mains_lines(const std::vector<double>& amplitudes,
                                             const int n_steps) {
  std::vector<std::vector<double>> out;
  for (const double line_hz : {50., 60., 100., 120.})
    for (int i = -n_steps; i <= n_steps; ++i)
      for (const double amplitude : amplitudes) out.push_back({amplitude, line_hz + 0.01 * i});
  return out;
}

}  // namespace

Effect sensor_gain() {
  return Effect{.id = "sensor_gain",
                .about = "gain of the moment sensor",
                .link = Link::sensor,
                .source = "MLX90393 data sheet, rev. 006, sensitivity; Doebelin 2004, ch. 3",
                .calibration = true,
                .model_form_error = 0.01,
                .parameters = {ratio_near_one("ratio", 0.02, 0.4, 2.5)},
                .starts = {{0.98}, {1.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.sensor.push_back([r = v[0]](Complex) -> Complex { return r; });
                }};
}

Effect sensor_lowpass() {
  return Effect{
      .id = "sensor_lowpass",
      .about = "a low-pass filter or an average over the conversion time",
      .link = Link::sensor,
      .source = "Doebelin 2004, ch. 3; Millman and Halkias 1972, bandwidth of equal stages",
      .model_form_error = 0.02,
      .parameters = {log_usual("corner", "Hz", 30., 250., 10., 3e4, 1e100),
                     normal("half_step", "s", 0., 5e-5, -2e-4, 2e-4, 0.),
                     relative("lags in series", uniform("lags", "1", 1., 3., 1.))},
      .starts = {{200., 0., 1.5}, {60., 0., 1.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        const double n = v[2], corner = 2. * std::numbers::pi * v[0];
        const double w = corner / (n * std::sqrt(std::exp2(1. / n) - 1.));
        // The time step is small relative to the delay of the filter.
        const double most = 0.3 / w, h = most * std::tanh(v[1] / most);
        chain.sensor.push_back([n, w, h](Complex s) -> Complex {
          return std::exp(s * h) * std::pow(1. + s / (n * w), -n);
        });
      }};
}

Effect sensor_nonlinearity() {
  return Effect{.id = "sensor_nonlinearity",
                .about = "the reading is not proportional to the moment",
                .link = Link::sensor,
                .source = "Worden and Tomlinson 2001, sec. 2.4; Pintelon and Schoukens 2012, ch. 4",
                .model_form_error = 0.1,
                .parameters = {relative("of the linear reading at the peak moment",
                                        normal("quadratic", "1", 0., 0.1, -0.6, 0.6, 0.)),
                               relative("of the linear reading at the peak moment",
                                        normal("cubic", "1", 0., 0.15, -1.5, 1.5, 0.))},
                .starts = {{0.01, 0.01}, {0.01, -0.01}, {-0.01, -0.1}, {0.05, 0.}, {-0.05, 0.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  chain.readout.push_back(
                      [b = v[0], c = v[1], unit = 1. / scales.joint_moment_n_m](double moment) {
                        const double x = moment * unit;
                        return moment * (1. + b * x + c * x * x / (1. + std::abs(c) * x * x));
                      });
                }};
}

Effect sensor_drift() {
  return Effect{
      .id = "sensor_drift",
      .about = "the offset drifts",
      .link = Link::sensor,
      .source = "El-Sheimy, Hou and Niu 2008, random walk by Allan variance",
      .irreducible = true,
      .model_form_error = 0.01,
      // Drift within one or two seconds may be a transient of the record's start.
      .needs = {.moved_s = 3.},
      .parameters = {log_uniform("walk", "N m/s^0.5", 1e-8, 1e-4, 0.)},
      .starts = {{3e-7}, {3e-6}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        chain.ramp_variance_rate += v[0] * v[0];
        // The walk relative to the straight line between its ends (Brownian bridge) has nearly
        // independent spectral lines.
        chain.noise.push_back([walk = v[0]](const RecordView& view, std::span<double> out) {
          const double n = static_cast<double>(view.n_samples);
          const double step_variance = walk * walk / view.sampling_rate_hz;
          for (std::size_t k = 0; k < out.size(); ++k) {
            const double sine = std::sin(std::numbers::pi * static_cast<double>(k + 1) / n);
            out[k] += n * step_variance / (4. * sine * sine);
          }
        });
      }};
}

Effect coil_feedthrough() {
  return Effect{.id = "coil_feedthrough",
                .about = "the field of the shaker's coil is read as moment",
                .link = Link::sensor,
                .source = "ISO 16063-33:2017, magnetic field sensitivity",
                .model_form_error = 0.01,
                .needs = {.base = true},
                .parameters = {relative("times |M / a| at 0 Hz (M / a itself is negative)",
                                        uniform("gain", "1", -0.7, 0.7, 0.))},
                .starts = {{0.02}, {-0.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  chain.feedthrough.push_back(
                      [b = v[0] * scales.static_gain](Complex) -> Complex { return b; });
                }};
}

Effect hum() {
  Parameter frequency = uniform("frequency", "Hz", 45., 125., 50.);
  frequency.step = 1e-3;
  frequency.largest_step = 0.01;
  return Effect{.id = "hum",
                .about = "a line from the mains",
                .link = Link::sensor,
                .source = "Ott 2009, cabling and grounding; Harris 1978, leakage of a line",
                .irreducible = true,
                .model_form_error = 0.01,
                .parameters = {log_uniform("amplitude", "N m", 1e-8, 1e-3, 0.), frequency},
                .starts = mains_lines({3e-7, 3e-6}, 0),
                .scanned = mains_lines({3e-6}, 12),
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.tones.push_back({v[0], v[1]});
                }};
}

}  // namespace vibrissa::diagnosis::effects
