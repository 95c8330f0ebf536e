#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <deal.II/dofs/dof_tools.h>

#include "fem/motion/linear_transient.h"
#include "fem/motion/nonlinear_transient.h"
#include "flow/drag_law.h"
#include "tests/fem/samples.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

SensorParameters undamped(SensorParameters parameters, const double air_density) {
  parameters.model.damping_ratios = {0.};
  parameters.wind.air.density = air_density;
  parameters.wind.relative_velocity = true;
  return parameters;
}

/// One period at the frequency, then silence.
std::vector<double> knock(const std::size_t n, const double size, const double frequency_hz) {
  std::vector<double> a(n, 0.);
  const auto length = static_cast<std::size_t>(rate_hz / frequency_hz);
  for (std::size_t i = 0; i < length; ++i)
    a[i] = size * std::sin(2. * M_PI * static_cast<double>(i) / static_cast<double>(length));
  return a;
}

/// The first mode's deflection along the wind, by height, on the axis of the wire.
std::map<double, double> shape_by_height(const Sensor& sensor) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(sensor.space().mapping(), sensor.space().dofs(),
                                               points);
  std::map<double, double> shape;
  for (const auto& [i, x] : points) {
    if (i % 3 == 0 && std::hypot(x[0], x[1]) < 1e-9) shape[x[2]] = sensor.modes()[0].shape[i];
  }
  return shape;
}

/// Simpson's rule over the layers between two heights, each of which has a node in its middle.
template <typename Function>
double integral(const std::map<double, double>& shape, const double from, const double to,
                const Function& f) {
  double sum = 0.;
  for (auto at = shape.begin(); at != shape.end(); ++at) {
    if (at->first < from - 1e-9 || at->first > to - 1e-9) continue;
    const auto middle = std::next(at), end = std::next(middle);
    sum += (end->first - at->first) / 6. *
           (f(at->first, at->second) + 4. * f(middle->first, middle->second) +
            f(end->first, end->second));
    at = middle;
  }
  return sum;
}

/// Twice the energy of the first mode about its steady deflection, at every sample.
std::vector<double> modal_energy(const Sensor& sensor, const TransientInput& input,
                                 const unsigned int substeps) {
  const Mode& mode = sensor.modes()[0];
  const double w = 2. * M_PI * mode.frequency_hz;
  Vector weight = sensor.space().make_vector(), force(weight);
  sensor.operators().mass->vmult(weight, mode.shape);
  if (!input.wind_speed.empty()) sensor.wind_surface().add_force(input.wind_speed.back(), force);
  const double steady = force * mode.shape / (w * w);
  std::vector<double> energy;
  simulate_linear(sensor, input, {1., substeps, false}, [&](std::size_t, const SolidState& state) {
    energy.push_back(std::pow(state.velocity * weight, 2) +
                     std::pow(w * (state.displacement * weight - steady), 2));
  });
  return energy;
}

/// Deviation of the whisker's decay in a steady wind from that of linearised drag.
double decay_error(const Sensor& sensor, const double wind_m_s, const double knock_m_s2) {
  const auto& g = sensor.parameters().geometry;
  const double f = sensor.modes()[0].frequency_hz, step = 1e-4 * wind_m_s;
  const auto pressure = [&](const double u) {
    return flow::drag_pressure(flow::DragBody::wire, g.wire_diameter, u,
                               sensor.parameters().wind.air);
  };
  // The coarse mesh's wire is 4 % too narrow.
  Vector force = sensor.space().make_vector();
  sensor.wind_surface().add_force(wind_m_s, force);
  const double width = force * sensor.space().translation(0) / (pressure(wind_m_s) * g.free_length);
  const double slope =
      width * (pressure(wind_m_s + step) - pressure(wind_m_s - step)) / (2. * step);
  const double expected = slope * integral(shape_by_height(sensor), g.base_height, g.tip_height(),
                                           [](double, const double phi) { return phi * phi; });
  const auto first = static_cast<std::size_t>(rate_hz / f);
  const auto n_periods = static_cast<std::size_t>(std::lround(5. * rate_hz / f));
  const std::size_t n = first + n_periods + 1;
  const auto a = knock(n, knock_m_s2, f);
  const std::vector<double> wind(n, wind_m_s);
  const auto energy = modal_energy(sensor, {rate_hz, n, a, {}, wind}, 2);
  const double rate = std::log(energy[first] / energy[first + n_periods]) /
                      (static_cast<double>(n_periods) / rate_hz);
  return rate / expected - 1.;
}

TEST(RelativeVelocity, SteadyWindDampsTheFirstModeAsLinearisedDragOnItsShape) {
  const Sensor sensor(undamped(whisker_sensor(1), 12.));
  // The tip is several times as fast as the wind, twice as fast, and far slower.
  const double strong = decay_error(sensor, 1., 200.), medium = decay_error(sensor, 1., 100.),
               weak = decay_error(sensor, 1., 5.);
  EXPECT_NEAR(weak, 0., 0.01);
  EXPECT_LT(std::abs(weak), 0.5 * medium);
  EXPECT_LT(medium, 0.5 * strong);
}

// x'' + w^2 x + b |x'| x' = 0: the amplitude falls as A' = -4 b w A^2 / (3 pi).
TEST(RelativeVelocity, InStillAirTheSwingFallsAsOneByTime) {
  auto parameters = undamped(flow_sensor(1), 12.);
  parameters.model.wind_on_wire = false;
  const Sensor sensor(parameters);
  const auto& g = parameters.geometry;
  const double f = sensor.modes()[0].frequency_hz, w = 2. * M_PI * f;
  const double bottom = g.tip_height() - g.fin_height;
  const double b = integral(
      shape_by_height(sensor), bottom, g.tip_height(), [&](const double z, const double phi) {
        const double width =
            std::lerp(g.fin_bottom_width, g.fin_top_width, (z - bottom) / g.fin_height);
        return 0.5 * 12. * 1.2 * width * std::pow(std::abs(phi), 3);
      });
  const auto first = static_cast<std::size_t>(rate_hz / f);
  const auto n_periods = static_cast<std::size_t>(std::lround(6. * rate_hz / f));
  const auto a = knock(first + n_periods + 1, 200., f);
  const auto energy = modal_energy(sensor, {rate_hz, a.size(), a, {}, {}}, 4);
  const auto amplitude = [&](const std::size_t i) { return std::sqrt(energy[i]) / w; };
  const double rise = 1. / amplitude(first + n_periods) - 1. / amplitude(first);
  const double expected = 4. * b * w / (3. * M_PI) * static_cast<double>(n_periods) / rate_hz;
  EXPECT_GT(expected, 0.3 / amplitude(first));
  EXPECT_NEAR(rise, expected, 0.03 * expected);
}

double difference_of(const std::vector<double>& x, const std::vector<double>& y) {
  double largest = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

std::vector<double> smooth(const std::size_t n, const double size, const double frequency_hz) {
  std::vector<double> a(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    a[i] = size * std::sin(2. * M_PI * frequency_hz * t) *
           std::pow(std::sin(M_PI * static_cast<double>(i) / static_cast<double>(n)), 2);
  }
  return a;
}

// Heavy air, so that the drag's own error is not lost in that of the vibration; by the first mode,
// because the inputs' corners at the samples ring modes that only finer steps resolve.
TEST(RelativeVelocity, ErrorFallsWithTheSquareOfTheStepInLinearAndFiniteStrain) {
  auto parameters = flow_sensor(1);
  parameters.wind.relative_velocity = true;
  parameters.wind.air.density = 30.;
  parameters.model.wind_on_wire = false;
  const Sensor sensor(parameters);
  const std::size_t n = 32;
  const auto a = smooth(n, 20., 40.), wind = smooth(n, 1., 30.), velocity = smooth(n, 0.1, 40.);
  const TransientInput input{rate_hz, n, a, {}, wind, velocity};
  Vector weight = sensor.space().make_vector();
  sensor.operators().mass->vmult(weight, sensor.modes()[0].shape);
  std::vector<std::vector<double>> linear(3), nonlinear(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const unsigned int substeps = 1u << k;
    const auto watch = [&](std::vector<double>& motion) {
      return [&](std::size_t, const SolidState& state) {
        motion.push_back(state.displacement * weight);
      };
    };
    simulate_linear(sensor, input, {0.9, substeps, false}, watch(linear[k]));
    simulate_nonlinear(sensor, input, {0.9, substeps, false, {}, {}}, watch(nonlinear[k]));
  }
  for (const auto& motion : {linear, nonlinear}) {
    EXPECT_NEAR(
        std::log2(difference_of(motion[0], motion[1]) / difference_of(motion[1], motion[2])), 2.,
        0.2);
  }
}

TEST(RelativeVelocity, SmallSwingsAtFiniteStrainAreThoseOfTheLinearSolid) {
  auto parameters = whisker_sensor(1);
  parameters.wind.relative_velocity = true;
  const Sensor sensor(parameters);
  const std::size_t n = 60;
  const auto a = smooth(n, 0.01, 25.), wind = smooth(n, 0.02, 12.), velocity = smooth(n, 1e-3, 30.);
  const TransientInput input{rate_hz, n, a, {}, wind, velocity};
  const auto linear = simulate_linear(sensor, input, {0.9, 4, true});
  const auto nonlinear = simulate_nonlinear(sensor, input, {0.9, 4, true, {}, {}});
  const auto largest = std::abs(*std::ranges::max_element(
      linear.base_moment, [](double x, double y) { return std::abs(x) < std::abs(y); }));
  EXPECT_LT(difference_of(linear.base_moment, nonlinear.base_moment), 1e-4 * largest);
  EXPECT_LT(linear.largest_route_difference(), 1e-6);
  EXPECT_LT(nonlinear.largest_route_difference(), 1e-6);
}

// Galileo: what counts is the speed of the air past the base.
TEST(RelativeVelocity, ABaseThatRunsBeforeTheWindFeelsTheRestOfIt) {
  auto parameters = whisker_sensor(1);
  parameters.wind.relative_velocity = true;
  const Sensor sensor(parameters);
  const std::vector<double> wind(20, 3.), base(20, 1.3), rest_of_it(20, 1.7);
  const auto running = simulate_linear(sensor, {rate_hz, 20, {}, {}, wind, base}, {0.9, 1, false});
  const auto still = simulate_linear(sensor, {rate_hz, 20, {}, {}, rest_of_it}, {0.9, 1, false});
  EXPECT_LT(difference_of(running.base_moment, still.base_moment),
            1e-10 * std::abs(still.base_moment.back()));
}

TEST(RelativeVelocity, EnergiesCloseWithTheWorkOfTheWindAmongThem) {
  auto parameters = whisker_sensor(1);
  parameters.wind.relative_velocity = true;
  parameters.wind.air.density = 12.;
  const Sensor sensor(parameters);
  const std::size_t n = 40;
  const auto a = smooth(n, 10., 25.), wind = smooth(n, 2., 12.);
  const auto output =
      simulate_nonlinear(sensor, {rate_hz, n, a, {}, wind}, {0.9, 2, false, {}, {}});
  double work = 0., error = 0.;
  for (const auto& energy : output.energy) {
    work = std::max(work, std::abs(energy.work_j));
    error = std::max(error, std::abs(energy.error_j(output.energy.front())));
  }
  EXPECT_LT(error, 1e-4 * work);
}

}  // namespace
}  // namespace vibrissa::fem
