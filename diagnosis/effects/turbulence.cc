#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

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

}  // namespace vibrissa::diagnosis::effects
