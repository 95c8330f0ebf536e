#include <algorithm>
#include <cmath>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

double wind_gain(const NominalModel& structure) {
  return structure.modes.empty() ? 0. : structure.modes.front().wind_gain;
}

/// +1 when the wind blows along the axis of the base motion: base acceleration then bends the
/// whisker opposite to the wind.
double along_the_axis(const NominalModel& structure) {
  return structure.base_response(0.).real() * wind_gain(structure) > 0. ? -1. : 1.;
}

/// Adds the power of stride samples of an oscillation with frequency strouhal_over_diameter u and
/// amplitude u^2 to the lines around this frequency.
void deposit(std::span<double> power, double u, double strouhal_over_diameter, double spread,
             double line_hz, double stride) {
  const double centre = strouhal_over_diameter * u / line_hz,
               width = std::max(0.5, spread * centre);
  const double total = stride * u * u * u * u / 4.;
  const double low = std::max(1., centre - 2. * width);
  const double high = std::min(static_cast<double>(power.size()), centre + 2. * width);
  // Recursive Gaussian: the ratio between neighbouring lines falls by a constant factor.
  const double first = std::ceil(low), z = (first - centre) / width, step = 1. / width;
  double value = total * std::exp(-0.5 * z * z) / (2.5066 * width);
  double ratio = std::exp(-step * (z + 0.5 * step));
  const double fall = std::exp(-step * step);
  for (auto k = static_cast<std::size_t>(first); static_cast<double>(k) <= high; ++k) {
    power[k - 1] += value;
    value *= ratio;
    ratio *= fall;
  }
}

}  // namespace

Effect drag_error() {
  return Effect{.id = "drag_error",
                .about = "another drag coefficient",
                .link = Link::wind,
                .source = "Hoerner 1965, ch. 3; White 2006: drag coefficients",
                .calibration = true,
                .model_form_error = 0.01,
                .needs = {.wind = true},
                .parameters = {ratio_near_one("ratio", 0.07, 0.4, 2.5)},
                .starts = {{0.95}, {1.05}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.drag_factor *= v[0];
                }};
}

Effect flow_lag() {
  return Effect{.id = "flow_lag",
                .about = "the wind at the whisker follows the measured wind with a time constant",
                .link = Link::wind,
                .source = "Wyngaard 1981, first-order response; Scanlan et al. 1974, bridge decks",
                .model_form_error = 0.02,
                .needs = {.wind = true},
                .parameters = {log_uniform("tau", "s", 2e-5, 0.4, 0.)},
                .starts = {{0.01}, {0.05}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.wind.push_back([tau = v[0]](std::span<double> u, double dt) {
                    if (u.empty()) return;
                    const double x = dt / tau, decay = std::exp(-x);
                    // Exact for wind that is linear between its samples and steady before the
                    // record.
                    const double old_share = (1. - decay) / x - decay,
                                 new_share = 1. - (1. - decay) / x;
                    double state = u[0], before = u[0];
                    for (double& value : u) {
                      const double now = value;
                      state = decay * state + old_share * before + new_share * now;
                      before = now;
                      value = state;
                    }
                  });
                }};
}

Effect relative_drag() {
  // A pendulum of static moment g / a that rotates by T / k has the velocity T' / (g w^2) at its
  // centre of percussion. The centre of the drag force is close to it.
  return Effect{.id = "relative_drag",
                .about = "drag depends on the speed of the air past the moving whisker",
                .link = Link::wind,
                .source = "Morison et al. 1950; Blevins 1990, ch. 6 and 8: relative velocity",
                .model_form_error = 0.1,
                .needs = {.base = true, .wind = true},
                .parameters = {relative("of the drag in steady wind",
                                        log_uniform("share", "1", 0.02, 5., 0.)),
                               relative("times the height of the centre of percussion",
                                        log_usual("lever", "1", 0.5, 2., 0.1, 10., 1.))},
                .starts = {{0.3, 1.}, {1.2, 1.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  const double inertia = scales.static_gain * std::pow(scales.first_mode_rad_s, 2);
                  const double velocity_per_rate = inertia > 0. ? v[0] * v[1] / inertia : 0.;
                  chain.relative_wind = {.on = v[0] > 0.,
                                         .base_share = v[0] * along_the_axis(chain.structure),
                                         .velocity_per_moment_rate = std::copysign(
                                             velocity_per_rate, wind_gain(chain.structure))};
                }};
}

Effect turbulence() {
  return Effect{.id = "turbulence",
                .about = "gusts that the anemometer does not see",
                .link = Link::wind,
                .source = "von Karman 1948, longitudinal spectrum; ESDU 85020",
                .irreducible = true,
                .model_form_error = 0.01,
                .needs = {.wind = true},
                .parameters = {relative("of the mean wind speed (rms)",
                                        log_uniform("intensity", "1", 0.001, 0.6, 0.)),
                               log_uniform("corner", "Hz", 0.5, 60., 5.)},
                .starts = {{0.03, 3.}, {0.03, 20.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.noise.push_back(
                      [c = v[0], corner = v[1]](const RecordView& view, std::span<double> out) {
                        if (!view.wind || view.wind_speed.empty()) return;
                        double mean_square = 0.;
                        for (const double u : view.wind_speed) mean_square += u * u;
                        mean_square /= static_cast<double>(view.wind_speed.size());
                        const double n = static_cast<double>(view.n_samples),
                                     line_hz = view.sampling_rate_hz / n;
                        // d(u |u|) = 2 |u| du; the spectrum's area is the variance.
                        double area = 0.;
                        std::vector<double> shape(out.size());
                        for (std::size_t k = 0; k < out.size(); ++k) {
                          const double f = line_hz * static_cast<double>(k + 1) / corner;
                          shape[k] = std::pow(1. + f * f, -5. / 6.);
                          area += 2. * shape[k];
                        }
                        const double level = 4. * mean_square * mean_square * c * c * n * n / area;
                        for (std::size_t k = 0; k < out.size(); ++k)
                          out[k] += level * shape[k] * std::norm(view.wind_response(k + 1));
                      });
                }};
}

Effect vortex_shedding() {
  return Effect{.id = "vortex_shedding",
                .about = "vortices leave the whisker periodically",
                .link = Link::wind,
                .source = "Blevins 1990, ch. 3; Vickery and Basu 1983, Gaussian band (B / sqrt 2)",
                .irreducible = true,
                .model_form_error = 0.01,
                .needs = {.wind = true},
                .parameters = {relative("of the squared wind speed",
                                        log_uniform("level", "1", 0.001, 1., 0.)),
                               log_uniform("strouhal_over_diameter", "1/m", 8., 180., 10.),
                               relative("of the shedding frequency",
                                        log_uniform("spread", "1", 0.01, 0.2, 0.03))},
                .starts = {{0.05, 12., 0.03},
                           {0.05, 20., 0.03},
                           {0.05, 35., 0.03},
                           {0.05, 60., 0.03},
                           {0.05, 110., 0.03}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.noise.push_back([c = v[0], ratio = v[1], spread = v[2]](
                                            const RecordView& view, std::span<double> out) {
                    if (!view.wind || view.wind_speed.empty()) return;
                    const double n = static_cast<double>(view.n_samples),
                                 line_hz = view.sampling_rate_hz / n;
                    std::vector<double> power(out.size(), 0.);
                    constexpr std::size_t stride = 8;
                    for (std::size_t i = 0; i < view.wind_speed.size(); i += stride)
                      deposit(power, std::abs(view.wind_speed[i]), ratio, spread, line_hz, stride);
                    for (std::size_t k = 0; k < out.size(); ++k)
                      if (power[k] > 0.)
                        out[k] += c * c * n * power[k] * std::norm(view.wind_response(k + 1));
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
