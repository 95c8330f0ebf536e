#include <algorithm>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

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
