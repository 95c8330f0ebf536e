#include "signals/model/reduced_model.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "tests/signals/peak.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Complex = std::complex<double>;
using Signal = std::vector<double>;
using test::peak;

using std::numbers::pi;
constexpr double participation = 0.011, moment_participation = 7e-4;  // √kg, √kg·m
constexpr double rigid = 9e-6;                                        // kg m

/// One bending mode in the xz-plane: M about y.
ReducedModel one_mode(double frequency_hz, double damping_ratio) {
  ReducedModel model;
  model.name = "one mode";
  model.modes = {{.frequency_hz = frequency_hz,
                  .damping_ratio = damping_ratio,
                  .participation = {participation, 0., 0.},
                  .moment_participation = {0., moment_participation, 0.}}};
  model.rigid_moment[1][0] = rigid;
  return model;
}

/// Modes of every kind, coupled in both planes, with a wind table.
ReducedModel rich_model() {
  ReducedModel model;
  model.name = "rich";
  model.axial_direction = {0.6, 0.8, 0.};
  model.modes = {{37.3, 0.05, {0.010, 0.002, 0.001}, {-2e-4, 7e-4, 1e-5}},
                 {37.3, 0.05, {-0.002, 0.010, 0.}, {-7e-4, -2e-4, 2e-5}},
                 {147., 0.02, {1e-3, 2e-3, 5e-3}, {1e-4, 3e-5, 4e-4}},
                 {90., 1.7, {-3e-3, 1e-3, 0.}, {2e-4, 1e-4, 0.}}};
  model.rigid_moment = {{{1e-8, -9e-6, 2e-7}, {9.5e-6, 2e-8, -1e-7}, {1e-7, 3e-7, 0.}}};
  model.wind = {.speed_m_s = {-4., -1., 0., 1., 3.},
                .modal_coefficient = {{3e-4, 1e-5, 2e-5, -1e-4},
                                      {4e-4, 2e-5, 1e-5, -2e-4},
                                      {5e-4, 3e-5, 0., -3e-4},
                                      {4e-4, 2e-5, -1e-5, -2e-4},
                                      {2e-4, 1e-5, 2e-5, -1e-4}},
                .moment_coefficient = {{-6e-7, 1e-6, 0.},
                                       {-7e-7, 2e-6, 1e-8},
                                       {-8e-7, 3e-6, 2e-8},
                                       {-7e-7, 2e-6, 1e-8},
                                       {-6e-7, 1e-6, 0.}}};
  return model;
}

Signal random_signal(std::size_t n, double peak, unsigned seed) {
  std::mt19937_64 random(seed);
  Signal x(n);
  for (double& value : x)
    value = peak * (2. * std::ldexp(static_cast<double>(random() >> 11), -53) - 1.);
  return x;
}

double largest_difference(const Signal& x, const Signal& y) {
  EXPECT_EQ(x.size(), y.size());
  double result = 0.;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    result = std::max(result, std::abs(x[i] - y[i]));
  return result;
}

Signal sampled(const std::function<double(double)>& f, double rate_hz, std::size_t n) {
  Signal x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = f(static_cast<double>(i) / rate_hz);
  return x;
}

Signal moment_for_base(const ReducedModel& model, double rate_hz, const Signal& acceleration) {
  return simulate(model, {.sampling_rate_hz = rate_hz,
                          .n_samples = acceleration.size(),
                          .base_acceleration = acceleration})
      .base_moment;
}

/// Acceleration of the unit oscillator after a step of its force, by the classical formulas.
double step_acceleration(double omega, double zeta, double t) {
  if (zeta == 1.) return std::exp(-omega * t) * (1. - omega * t);
  if (zeta < 1.) {
    const double root = std::sqrt(1. - zeta * zeta), angle = omega * root * t;
    return std::exp(-zeta * omega * t) * (std::cos(angle) - zeta / root * std::sin(angle));
  }
  const double root = std::sqrt(zeta * zeta - 1.);
  const double fast = omega * (zeta + root), slow = omega * omega / fast;
  return (fast * std::exp(-fast * t) - slow * std::exp(-slow * t)) / (fast - slow);
}

// M = -J a - L q'' with q'' = -Gamma a (step acceleration).
TEST(ReducedModelStep, IsTheClosedFormForAnyDamping) {
  constexpr double rate_hz = 1000., a = 2.5;
  constexpr std::size_t n = 60'000;
  for (const double frequency_hz : {1e-4, 0.3, 37.3, 480., 2000.})
    for (const double zeta : {0., 0.027, 0.7, 1., 3.}) {
      SCOPED_TRACE(testing::Message() << frequency_hz << " Hz, zeta " << zeta);
      const auto found = moment_for_base(one_mode(frequency_hz, zeta), rate_hz, Signal(n, a));
      const auto wanted = sampled(
          [&](double t) {
            return -rigid * a + moment_participation * participation * a *
                                    step_acceleration(2. * pi * frequency_hz, zeta, t);
          },
          rate_hz, n);
      // An undamped phase w t loses w t times the rounding of w.
      const double cycles_rounding = 2. * pi * frequency_hz * 60. * 2.2e-16;
      EXPECT_LT(largest_difference(found, wanted) / (rigid * a), 1e-12 + 4. * cycles_rounding);
    }
}

// Response at rest to f = sin(W t): the imaginary part of e^(jWt) / (w^2 - W^2 + 2 j zeta w W) and
// the free motion that starts it from rest.
double sine_moment(double omega, double zeta, double drive, double t) {
  const Complex gain = 1. / Complex(omega * omega - drive * drive, 2. * zeta * omega * drive);
  const Complex decay(-zeta * omega, omega * std::sqrt(1. - zeta * zeta));
  const double q0 = -gain.imag(), v0 = -drive * gain.real();
  // The free motion with q(0) = q0, q'(0) = v0 is Re(c e^(decay t)).
  const Complex c(q0, -(v0 - decay.real() * q0) / decay.imag());
  const double acceleration = -drive * drive * (gain * std::polar(1., drive * t)).imag() +
                              (c * decay * decay * std::exp(decay * t)).real();
  return -rigid * std::sin(drive * t) + moment_participation * participation * acceleration;
}

TEST(ReducedModelSine, ConvergesToTheClosedFormAtSecondOrder) {
  const double omega = 2. * pi * 37.3, drive = 2. * pi * 23.;
  const auto error = [&](double rate_hz) {
    const auto n = static_cast<std::size_t>(rate_hz);
    const auto a = sampled([&](double t) { return std::sin(drive * t); }, rate_hz, n);
    const auto wanted =
        sampled([&](double t) { return sine_moment(omega, 0.05, drive, t); }, rate_hz, n);
    return largest_difference(moment_for_base(one_mode(37.3, 0.05), rate_hz, a), wanted) / rigid;
  };
  const double coarse = error(4000.), fine = error(8000.);
  EXPECT_NEAR(std::log2(coarse / fine), 2., 0.02);
  EXPECT_LT(fine, 1e-4);
}

/// The equations of the header by Runge-Kutta of fourth order, forces linear between samples.
ReducedOutput runge_kutta(const ReducedModel& model, double rate_hz, const Signal& axial,
                          const Signal& cross, const Signal& wind, std::size_t n_substeps);

std::array<double, 3> wind_moment_vector(const ReducedModel& model, double u) {
  const auto& speeds = model.wind.speed_m_s;
  std::array<double, 3> result{};
  for (std::size_t d = 0; d < 3; ++d) {
    double value = model.wind.moment_coefficient.front()[d];
    for (std::size_t i = 0; i + 1 < speeds.size(); ++i)
      if (u >= speeds[i])
        value =
            std::lerp(model.wind.moment_coefficient[i][d], model.wind.moment_coefficient[i + 1][d],
                      std::min(1., (u - speeds[i]) / (speeds[i + 1] - speeds[i])));
    result[d] = value * u * std::abs(u);
  }
  return result;
}

double modal_wind_force(const ReducedModel& model, std::size_t mode, double u) {
  const auto& speeds = model.wind.speed_m_s;
  double value = model.wind.modal_coefficient.front()[mode];
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i)
    if (u >= speeds[i])
      value = std::lerp(model.wind.modal_coefficient[i][mode],
                        model.wind.modal_coefficient[i + 1][mode],
                        std::min(1., (u - speeds[i]) / (speeds[i + 1] - speeds[i])));
  return value * u * std::abs(u);
}

struct ModeTrajectory {
  Signal position, velocity, force;
};

ModeTrajectory integrate(const ReducedMode& mode, const Signal& force, double rate_hz,
                         std::size_t n_substeps) {
  const double omega = 2. * pi * mode.frequency_hz;
  const double h = 1. / (rate_hz * static_cast<double>(n_substeps));
  const auto acceleration = [&](double q, double v, double f) {
    return f - 2. * mode.damping_ratio * omega * v - omega * omega * q;
  };
  ModeTrajectory path{{0.}, {0.}, force};
  double q = 0., v = 0.;
  for (std::size_t i = 0; i + 1 < force.size(); ++i) {
    for (std::size_t s = 0; s < n_substeps; ++s) {
      const auto f = [&](double part) {
        return std::lerp(force[i], force[i + 1],
                         (static_cast<double>(s) + part) / static_cast<double>(n_substeps));
      };
      const double a1 = acceleration(q, v, f(0.)), v2 = v + 0.5 * h * a1;
      const double a2 = acceleration(q + 0.5 * h * v, v2, f(0.5)), v3 = v + 0.5 * h * a2;
      const double a3 = acceleration(q + 0.5 * h * v2, v3, f(0.5)), v4 = v + h * a3;
      const double a4 = acceleration(q + h * v3, v4, f(1.));
      q += h / 6. * (v + 2. * v2 + 2. * v3 + v4);
      v += h / 6. * (a1 + 2. * a2 + 2. * a3 + a4);
    }
    path.position.push_back(q);
    path.velocity.push_back(v);
  }
  return path;
}

ReducedOutput runge_kutta(const ReducedModel& model, double rate_hz, const Signal& axial,
                          const Signal& cross, const Signal& wind, std::size_t n_substeps) {
  const auto& e = model.axial_direction;
  const auto acceleration = [&](std::size_t i) {
    return std::array{axial[i] * e[0] - cross[i] * e[1], axial[i] * e[1] + cross[i] * e[0], 0.};
  };
  std::vector<std::array<double, 3>> moment(axial.size());
  for (std::size_t i = 0; i < axial.size(); ++i) {
    moment[i] = wind_moment_vector(model, wind[i]);
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t j = 0; j < 3; ++j)
        moment[i][d] -= model.rigid_moment[d][j] * acceleration(i)[j];
  }
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const ReducedMode& mode = model.modes[k];
    const double omega = 2. * pi * mode.frequency_hz;
    Signal force(axial.size());
    for (std::size_t i = 0; i < axial.size(); ++i) {
      force[i] = modal_wind_force(model, k, wind[i]);
      for (std::size_t d = 0; d < 3; ++d) force[i] -= mode.participation[d] * acceleration(i)[d];
    }
    const auto path = integrate(mode, force, rate_hz, n_substeps);
    for (std::size_t i = 0; i < axial.size(); ++i)
      for (std::size_t d = 0; d < 3; ++d)
        moment[i][d] += mode.moment_participation[d] *
                        (omega * omega * path.position[i] +
                         2. * mode.damping_ratio * omega * path.velocity[i] - force[i]);
  }
  ReducedOutput output;
  for (const auto& m : moment) {
    output.base_moment.push_back(-m[0] * e[1] + m[1] * e[0]);
    output.cross_moment.push_back(-m[0] * e[0] - m[1] * e[1]);
  }
  return output;
}

TEST(ReducedModelExactness, RungeKuttaConvergesToItAtFourthOrder) {
  const auto model = rich_model();
  constexpr double rate_hz = 1000.;
  constexpr std::size_t n = 300;
  const auto axial = random_signal(n, 3., 1), cross = random_signal(n, 2., 2),
             wind = random_signal(n, 4.5, 3);
  const auto exact = simulate(model, {rate_hz, n, axial, cross, wind});
  const auto errors = [&](std::size_t n_substeps) {
    const auto approximate = runge_kutta(model, rate_hz, axial, cross, wind, n_substeps);
    return std::array{largest_difference(approximate.base_moment, exact.base_moment),
                      largest_difference(approximate.cross_moment, exact.cross_moment)};
  };
  const auto coarse = errors(16), fine = errors(32), finest = errors(200);
  const double scale = peak(exact.base_moment);
  for (std::size_t output = 0; output < 2; ++output) {
    EXPECT_NEAR(std::log2(coarse[output] / fine[output]), 4., 0.15);
    EXPECT_LT(finest[output] / scale, 1e-9);
  }
}

TEST(ReducedModelExactness, HalvingTheStepOfAPiecewiseLinearInputChangesNothing) {
  const auto model = rich_model();
  constexpr std::size_t n = 5000;
  const auto axial = random_signal(n, 3., 1), cross = random_signal(n, 3., 2);
  const auto refined = [&](const Signal& x) {
    Signal fine(2 * n - 1);
    for (std::size_t i = 0; i < fine.size(); ++i) fine[i] = 0.5 * (x[i / 2] + x[(i + 1) / 2]);
    return fine;
  };
  const auto fine_axial = refined(axial), fine_cross = refined(cross);
  const auto coarse = simulate(model, {1000., n, axial, cross, {}});
  auto fine = simulate(model, {2000., 2 * n - 1, fine_axial, fine_cross, {}});
  for (Signal* moment : {&fine.base_moment, &fine.cross_moment})
    for (std::size_t i = 0; i < n; ++i) (*moment)[i] = (*moment)[2 * i];
  fine.base_moment.resize(n);
  fine.cross_moment.resize(n);
  const double scale = peak(coarse.base_moment);
  EXPECT_LT(largest_difference(coarse.base_moment, fine.base_moment) / scale, 1e-12);
  EXPECT_LT(largest_difference(coarse.cross_moment, fine.cross_moment) / scale, 1e-12);
}

TEST(ReducedModelLimits, SlowAccelerationGivesTheRigidMomentWithReversedSign) {
  const auto moment = moment_for_base(one_mode(37.3, 0.05), 1000., Signal(4000, 2.));
  EXPECT_NEAR(moment.back() / (-rigid * 2.), 1., 1e-12);
  EXPECT_LT(moment.back(), 0.);
}

TEST(ReducedModelLimits, TheFirstInstantIsTheSensorWithItsModesStillAtRest) {
  const auto moment = moment_for_base(one_mode(37.3, 0.05), 1000., Signal(2, 2.));
  EXPECT_NEAR(moment.front(), -(rigid - moment_participation * participation) * 2., 1e-20);
}

TEST(ReducedModelLimits, SteadyWindGivesItsStaticMomentPositiveInTheAxialDirection) {
  const auto model = rich_model();
  for (const double u : {-6., -2.5, 0.4, 2., 5.}) {
    const Signal wind(4000, u);
    const auto output = simulate(model, {1000., 4000, {}, {}, wind});
    const auto m = wind_moment_vector(model, u);
    const double wanted = -0.8 * m[0] + 0.6 * m[1];
    EXPECT_NEAR(output.base_moment.back() / wanted, 1., 1e-12);
    EXPECT_NEAR(steady_wind_moment(model, u) / wanted, 1., 1e-14);
    EXPECT_NEAR(output.cross_moment.back(), -0.6 * m[0] - 0.8 * m[1], 1e-12 * std::abs(wanted));
    EXPECT_GT(output.base_moment.back() * u, 0.);
  }
}

// Straight from the equation of motion, not rearranged as in the code.
Complex response_by_header(const ReducedModel& model, double frequency_hz) {
  const auto& e = model.axial_direction;
  const auto axis = model.moment_axis();
  const auto along = [&](const std::array<double, 3>& v, const std::array<double, 3>& direction) {
    return v[0] * direction[0] + v[1] * direction[1] + v[2] * direction[2];
  };
  double remainder = 0.;
  for (std::size_t i = 0; i < 3; ++i) remainder += axis[i] * along(model.rigid_moment[i], e);
  Complex sum = 0.;
  const Complex s(0., 2. * pi * frequency_hz);
  for (const ReducedMode& mode : model.modes) {
    const double omega = 2. * pi * mode.frequency_hz;
    const double gain = along(mode.moment_participation, axis) * along(mode.participation, e);
    remainder -= gain;
    const Complex stiffness = omega * omega + 2. * mode.damping_ratio * omega * s;
    sum -= gain * stiffness / (s * s + stiffness);
  }
  return sum - remainder;
}

TEST(BaseResponse, IsTheEquationOfTheModel) {
  const auto model = rich_model();
  const Signal frequencies{0., 0.5, 10., 37.3, 60., 147., 400.};
  const auto response = base_response(model, frequencies);
  ASSERT_EQ(response.size(), frequencies.size());
  const double scale = std::abs(response[0]);
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    EXPECT_LT(std::abs(response[i] - response_by_header(model, frequencies[i])) / scale, 1e-12);
  EXPECT_LT(response[0].real(), 0.);
  EXPECT_EQ(response[0].imag(), 0.);
}

// A sine drawn with straight lines between samples has 1 - (pi f / rate)^2 / 3 of its amplitude and
// images of the same order.
TEST(BaseResponse, EqualsTheSimulatedSineInMagnitudeAndPhase) {
  const auto model = rich_model();
  constexpr double rate_hz = 20'000.;
  constexpr std::size_t n = 60'000, n_last = 20'000;
  for (const double f : {5., 31., 37., 100.}) {
    const auto a = sampled([&](double t) { return std::cos(2. * pi * f * t); }, rate_hz, n);
    const auto moment = moment_for_base(model, rate_hz, a);
    Complex found = 0.;
    for (std::size_t i = n - n_last; i < n; ++i)
      found +=
          2. / n_last * moment[i] * std::polar(1., -2. * pi * f * static_cast<double>(i) / rate_hz);
    const Complex wanted = base_response(model, Signal{f})[0];
    const double hold_error = std::pow(pi * f / rate_hz, 2);
    EXPECT_LT(std::abs(found - wanted) / std::abs(wanted), 1e-8 + hold_error) << f << " Hz";
  }
}

TEST(ReducedModel, ResponsesToSeparateInputsAddUp) {
  const auto model = rich_model();
  constexpr std::size_t n = 2000;
  const auto axial = random_signal(n, 3., 1), cross = random_signal(n, 2., 2),
             wind = random_signal(n, 4., 3);
  const auto all = simulate(model, {1000., n, axial, cross, wind});
  auto sum = simulate(model, {1000., n, axial, {}, {}});
  for (const auto& part :
       {simulate(model, {1000., n, {}, cross, {}}), simulate(model, {1000., n, {}, {}, wind})})
    for (std::size_t i = 0; i < n; ++i) {
      sum.base_moment[i] += part.base_moment[i];
      sum.cross_moment[i] += part.cross_moment[i];
    }
  EXPECT_LT(largest_difference(all.base_moment, sum.base_moment), 1e-13 * peak(all.base_moment));
  EXPECT_LT(largest_difference(all.cross_moment, sum.cross_moment), 1e-13 * peak(all.base_moment));
}

TEST(ReducedModel, AnEmptyInputIsZero) {
  const auto model = rich_model();
  constexpr std::size_t n = 500;
  const Signal zero(n, 0.);
  for (unsigned used = 0; used < 8; ++used) {
    const auto signal = [&](unsigned bit) {
      return (used & bit) != 0 ? random_signal(n, 2., bit) : Signal();
    };
    const auto axial = signal(1), cross = signal(2), wind = signal(4);
    const auto or_zero = [&](const Signal& x) -> const Signal& { return x.empty() ? zero : x; };
    const auto empty = simulate(model, {1000., n, axial, cross, wind});
    const auto zeros = simulate(model, {1000., n, or_zero(axial), or_zero(cross), or_zero(wind)});
    EXPECT_EQ(empty.base_moment, zeros.base_moment);
    EXPECT_EQ(empty.cross_moment, zeros.cross_moment);
  }
}

TEST(ReducedModel, WindActsWithTheSquareOfItsSpeedAndItsSign) {
  auto model = rich_model();
  for (auto& row : model.wind.modal_coefficient) row = model.wind.modal_coefficient.front();
  for (auto& row : model.wind.moment_coefficient) row = model.wind.moment_coefficient.front();
  constexpr std::size_t n = 1000;
  const auto wind = random_signal(n, 2., 3);
  auto minus_double = wind;
  for (double& u : minus_double) u *= -2.;
  const auto first = simulate(model, {1000., n, {}, {}, wind});
  const auto second = simulate(model, {1000., n, {}, {}, minus_double});
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_NEAR(second.base_moment[i], -4. * first.base_moment[i],
                1e-13 * peak(second.base_moment));
}

TEST(ReducedModel, WindCoefficientsAreInterpolatedAndKeptBeyondTheEnds) {
  auto model = one_mode(37.3, 0.05);
  model.wind = {.speed_m_s = {1., 3.},
                .modal_coefficient = {{1e-4}, {2e-4}},
                .moment_coefficient = {{0., 1e-6, 0.}, {0., 2e-6, 0.}}};
  EXPECT_DOUBLE_EQ(steady_wind_moment(model, 2.5), 1.75e-6 * 6.25);
  EXPECT_DOUBLE_EQ(steady_wind_moment(model, 3.), 2e-6 * 9.);
  EXPECT_DOUBLE_EQ(steady_wind_moment(model, 10.), 2e-6 * 100.);
  EXPECT_DOUBLE_EQ(steady_wind_moment(model, 0.5), 1e-6 * 0.25);
  EXPECT_DOUBLE_EQ(steady_wind_moment(model, -10.), -1e-6 * 100.);
  EXPECT_EQ(steady_wind_moment(model, 0.), 0.);
  model.wind.speed_m_s.pop_back();
  model.wind.modal_coefficient.pop_back();
  model.wind.moment_coefficient.pop_back();
  EXPECT_DOUBLE_EQ(steady_wind_moment(model, 10.), 1e-6 * 100.);
}

/// The same sensor in both planes.
ReducedModel symmetric_sensor() {
  auto model = one_mode(37.3, 0.05);
  model.modes.push_back({37.3, 0.05, {0., participation, 0.}, {-moment_participation, 0., 0.}});
  model.rigid_moment[0][1] = -rigid;
  return model;
}

TEST(ReducedModel, ASymmetricSensorRespondsAcrossAsAlong) {
  const auto a = random_signal(500, 2., 1);
  const auto along = simulate(symmetric_sensor(), {1000., 500, a, {}, {}});
  const auto across = simulate(symmetric_sensor(), {1000., 500, {}, a, {}});
  EXPECT_LT(largest_difference(along.base_moment, across.cross_moment), 1e-18);
  EXPECT_GT(peak(along.base_moment), 1e-6);
  EXPECT_EQ(peak(along.cross_moment), 0.);
  EXPECT_EQ(peak(across.base_moment), 0.);
}

TEST(ReducedModel, ASymmetricSensorRespondsAlikeInEveryAxialDirection) {
  const auto a = random_signal(500, 2., 1);
  auto turned = symmetric_sensor();
  turned.axial_direction = {std::cos(0.7), std::sin(0.7), 0.};
  const auto straight = simulate(symmetric_sensor(), {1000., 500, a, {}, {}});
  EXPECT_LT(largest_difference(straight.base_moment, moment_for_base(turned, 1000., a)), 1e-18);
  EXPECT_LT(std::abs(base_response(turned, Signal{30.})[0] -
                     base_response(symmetric_sensor(), Signal{30.})[0]),
            1e-18);
}

TEST(ReducedModel, AnyNumberOfModesIsTheSumOfThem) {
  const auto a = random_signal(400, 2., 1);
  for (const std::size_t n_modes : {0u, 1u, 7u, 8u, 9u, 17u}) {
    ReducedModel all;
    Signal sum(400, 0.);
    for (std::size_t k = 0; k < n_modes; ++k) {
      auto single = one_mode(20. + 31. * static_cast<double>(k), 0.03);
      single.rigid_moment = {};
      all.modes.push_back(single.modes.front());
      const auto part = moment_for_base(single, 1000., a);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
    }
    EXPECT_LT(largest_difference(moment_for_base(all, 1000., a), sum), 1e-13 * peak(sum) + 1e-30);
  }
}

TEST(ReducedModel, ARingDownEndsInSilence) {
  Signal a(40'000, 0.);
  a[3] = 5.;
  const auto moment = moment_for_base(rich_model(), 1000., a);
  EXPECT_GT(std::abs(moment[1000]), 0.);
  EXPECT_EQ(moment.back(), 0.);
  for (const double m : moment) EXPECT_TRUE(m == 0. || std::isnormal(m));
}

TEST(ReducedModel, TheMomentAxisIsTheTurnedAxialDirection) {
  EXPECT_THAT(rich_model().moment_axis(), testing::ElementsAre(-0.8, 0.6, 0.));
}

TEST(Simulate, RefusesInputsThatDoNotFit) {
  const auto model = one_mode(37.3, 0.05);
  const Signal ten(10, 1.), nine(9, 1.), calm(10, 0.);
  const auto run = [&](ReducedInput input) { return [=] { simulate(model, input); }; };
  EXPECT_NO_THROW(run({1000., 10, ten, ten, calm})());
  EXPECT_THAT(run({1000., 10, nine, ten, {}}),
              ThrowsMessage<UserError>(HasSubstr("base_acceleration has 9 samples instead of 10")));
  EXPECT_THAT(run({1000., 10, ten, nine, {}}),
              ThrowsMessage<UserError>(HasSubstr("cross_acceleration has 9")));
  EXPECT_THAT(run({1000., 10, ten, ten, nine}),
              ThrowsMessage<UserError>(HasSubstr("wind_speed has 9")));
  EXPECT_THAT(run({1000., 10, ten, ten, ten}),
              ThrowsMessage<UserError>(HasSubstr("'one mode': the input has wind")));
  EXPECT_THAT(run({0., 10, ten, {}, {}}), ThrowsMessage<UserError>(HasSubstr("sampling rate 0")));
  EXPECT_THAT([&] { steady_wind_moment(model, 1.); },
              ThrowsMessage<UserError>(HasSubstr("no wind load")));
}

struct Spoilt {
  std::function<void(ReducedModel&)> spoil;
  std::string message;
};

TEST(CheckReducedModel, NamesTheEntryThatIsWrong) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Spoilt> cases{
      {[](auto& m) { m.modes[2].frequency_hz = 0.; }, "modes[2].frequency_hz = 0 is not positive"},
      {[](auto& m) { m.modes[0].frequency_hz = -3.; }, "modes[0].frequency_hz = -3"},
      {[](auto& m) { m.modes[1].frequency_hz = INFINITY; }, "modes[1].frequency_hz = inf"},
      {[](auto& m) { m.modes[1].damping_ratio = -1e-9; }, "modes[1].damping_ratio = -1e-09"},
      {[](auto& m) { m.modes[3].participation[1] = nan; }, "modes[3].participation[1] = nan"},
      {[](auto& m) { m.modes[3].moment_participation[2] = nan; }, "moment_participation[2] = nan"},
      {[](auto& m) { m.rigid_moment[1][2] = INFINITY; }, "rigid_moment[1][2] = inf"},
      {[](auto& m) {
         m.axial_direction = {1., 1., 0.};
       },
       "axial_direction is not a unit vector"},
      {[](auto& m) {
         m.axial_direction = {0., 0., 1.};
       },
       "axial_direction is not a unit vector"},
      {[](auto& m) {
         m.axial_direction = {1., 0., 0.1};
       },
       "axial_direction is not a unit vector"},
      {[](auto& m) {
         m.axial_direction = {nan, 0., 0.};
       },
       "axial_direction[0] = nan"},
      {[](auto& m) { m.wind.speed_m_s[1] = -4.; }, "wind.speed_m_s[1] = -4 is not above"},
      {[](auto& m) { m.wind.speed_m_s[4] = INFINITY; }, "wind.speed_m_s[4] = inf"},
      {[](auto& m) { m.wind.speed_m_s.pop_back(); },
       "wind.modal_coefficient has 5 entries instead of 4"},
      {[](auto& m) { m.wind.modal_coefficient[2].pop_back(); },
       "wind.modal_coefficient[2] has 3 entries instead of 4"},
      {[](auto& m) { m.wind.modal_coefficient[2][1] = nan; }, "wind.modal_coefficient[2][1] = nan"},
      {[](auto& m) { m.wind.moment_coefficient.pop_back(); },
       "wind.moment_coefficient has 4 entries instead of 5"},
      {[](auto& m) { m.wind.moment_coefficient[0][1] = nan; },
       "wind.moment_coefficient[0][1] = nan"},
      {[](auto& m) { m.sensitivities[0].frequency.pop_back(); },
       "sensitivities[0].frequency has 3 entries instead of 4"},
      {[](auto& m) { m.sensitivities[0].base_gain[1] = nan; },
       "sensitivities[0].base_gain[1] = nan"},
      {[](auto& m) { m.sensitivities[0].wind_gain.clear(); },
       "sensitivities[0].wind_gain has 0 entries instead of 4"},
      {[](auto& m) { m.sensitivities[0].nominal_value = nan; }, "sensitivities[0].nominal_value"},
      {[](auto& m) { m.sensitivities[0].static_base_moment = nan; }, ".static_base_moment = nan"},
      {[](auto& m) { m.sensitivities[0].static_wind_moment = nan; }, ".static_wind_moment = nan"}};
  auto good = rich_model();
  good.sensitivities = {{.parameter = "silicone_modulus",
                         .nominal_value = 2.04e6,
                         .unit = "Pa",
                         .frequency = Signal(4, 0.4),
                         .base_gain = Signal(4, 0.),
                         .wind_gain = Signal(4, 0.)}};
  EXPECT_NO_THROW(check(good));
  const Signal a(10, 1.);
  for (const auto& [spoil, message] : cases) {
    auto model = good;
    spoil(model);
    const auto says = ThrowsMessage<UserError>(
        testing::AllOf(HasSubstr("reduced model 'rich'"), HasSubstr(message)));
    EXPECT_THAT([&] { check(model); }, says);
    EXPECT_THAT([&] { simulate(model, {1000., 10, a, {}, {}}); }, says);
    EXPECT_THAT([&] { base_response(model, a); }, says);
  }
}

}  // namespace
}  // namespace vibrissa::signals
