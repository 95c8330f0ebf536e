#include "apps/solid/jobs/full_order_check.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fem/motion/linear_transient.h"
#include "fem/sensor/vtk_output.h"
#include "report/text/file_name.h"
#include "signals/system/progress.h"

namespace vibrissa::apps {

namespace {

// The integrator's own error at this step is about 0.1 % at 60 Hz; it falls with the step's square.
constexpr double largest_step_s = 1e-4;
constexpr std::size_t samples_per_frame = 5;

std::span<const double> start_of(const std::vector<double>& values, const std::size_t n) {
  return std::span(values).first(std::min(n, values.size()));
}

}  // namespace

nlohmann::json check_full_order(const fem::Sensor& sensor, const signals::ReducedModel& model,
                                const sensor_case::Case& parameters,
                                const sensor_case::Inputs& inputs,
                                const std::filesystem::path& folder, const bool show_progress) {
  const double rate_hz = parameters.records.sampling_rate_hz;
  const auto wanted = static_cast<std::size_t>(parameters.output.full_order_duration_s * rate_hz);
  const std::size_t n = std::clamp<std::size_t>(wanted, 2, parameters.records.n_samples());
  const auto a = start_of(inputs.base_acceleration_m_s2, n);
  const auto u = start_of(inputs.wind_speed_m_s, n);
  const auto substeps = static_cast<unsigned int>(std::ceil(1. / (rate_hz * largest_step_s)));

  std::vector<double> times;
  std::vector<std::string> names;
  signals::Progress progress("full-order solid", n, show_progress);
  const auto observe = [&](const std::size_t i, const fem::SolidState& state) {
    progress.advance();
    if (!parameters.output.vtk || i % samples_per_frame != 0) return;
    times.push_back(static_cast<double>(i) / rate_hz);
    const std::string name = "transient_" + std::to_string(names.size()) + ".vtu";
    report::make_folder(folder);
    const auto written = fem::write_vtu(folder / name, sensor, state.displacement, times.back());
    names.push_back(written.filename().string());
  };
  const auto full =
      fem::simulate_linear(sensor, {rate_hz, n, a, {}, u}, {0.9, substeps, true}, observe);
  if (!names.empty()) fem::write_pvd(folder / "transient.pvd", times, names);

  const auto reduced = signals::simulate(model, {rate_hz, n, a, {}, u});
  double peak = 0., difference = 0.;
  for (std::size_t i = 0; i < n; ++i) {
    peak = std::max(peak, std::abs(full.base_moment[i]));
    difference = std::max(difference, std::abs(full.base_moment[i] - reduced.base_moment[i]));
  }
  return {{"duration_s", static_cast<double>(n) / rate_hz},
          {"step_s", 1. / (rate_hz * substeps)},
          {"reduced_minus_full_over_peak", peak > 0. ? difference / peak : 0.},
          {"two_moment_routes_relative_difference", full.largest_route_difference()}};
}

}  // namespace vibrissa::apps
