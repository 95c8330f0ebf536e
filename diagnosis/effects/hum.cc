#include <numbers>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// Starting values about the mains frequencies and their harmonics. Mains frequency varies by a
/// tenth of a hertz, and the step is small because long records resolve such differences, so basins
/// of attraction are narrow.
std::vector<std::vector<double>> lines_nearby() {
  std::vector<std::vector<double>> out;
  for (const double line_hz : {50., 60., 100., 120.})
    for (int i = -12; i <= 12; ++i) out.push_back({3e-6, line_hz + 0.01 * i});
  return out;
}

}  // namespace

Effect hum() {
  Parameter frequency = uniform("frequency", "Hz", 45., 125., 50.);
  frequency.step = 1e-3;
  frequency.largest_step = 0.01;
  return Effect{
      .id = "hum",
      .about = "a line from the mains",
      .link = Link::sensor,
      .source = "Ott 2009, cabling and grounding; Harris 1978, leakage of a line",
      .irreducible = true,
      .model_form_error = 0.01,
      .parameters = {log_uniform("amplitude", "N m", 1e-8, 1e-3, 0.), frequency},
      .starts = {{3e-7, 50.},
                 {3e-6, 50.},
                 {3e-7, 60.},
                 {3e-6, 60.},
                 {3e-7, 100.},
                 {3e-6, 100.},
                 {3e-7, 120.},
                 {3e-6, 120.}},
      .scanned = lines_nearby(),
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        chain.noise.push_back([a = v[0], f = v[1]](const RecordView& view, std::span<double> out) {
          const double n = static_cast<double>(view.n_samples), line_hz = view.sampling_rate_hz / n;
          for (std::size_t k = 0; k < out.size(); ++k) {
            const double x = std::numbers::pi * (static_cast<double>(k + 1) - f / line_hz);
            const double shape = std::abs(x) < 1e-6 ? 1. : std::sin(x) / x;
            out[k] += 0.25 * a * a * n * n * shape * shape;
          }
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
