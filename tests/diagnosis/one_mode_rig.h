#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis::test {

/// A whisker with one mode on a rig, integrated by classical Runge-Kutta with many steps per
/// sample. It shares no code with the tested chain.
///   x'' + c0 loss x' + k0 ((stiffness + warming) x + cubic x^3 + further) = -a + drag w |w|,
///   M = moment_mass (k x + c x'), w = u - own_motion (x' + base velocity)
/// with the clock of the moment channel delayed by delay_s. With the readout rotation the reading
/// is moment_mass k0 x; a rotated rig has the cosine of its excitation. A second mode that the base
/// excites adds extra_residue moment_mass y,  y'' + 2 0.02 w y' + w^2 y = w^2 a.
struct OneModeRig {
  double frequency_hz = 35., damping_ratio = 0.05;
  double moment_mass = 6e-5;  // kg m: M / a at rest is -this
  double drag = 0.8;          // (m/s^2) / (m/s)^2
  double own_motion = 0.;     // share of its velocity in the relative wind
  double stiffness = 1., loss = 1.;
  double cubic = 0.;    // 1/m^2
  double delay_s = 0.;  // whole steps of integration
  double moment_noise = 0., acceleration_noise = 0.;
  double hum = 0., hum_hz = 50.1;  // N m
  double extra_hz = 70., extra_residue = 0.;
  double rate_hz = 500.;
  signals::Readout readout = signals::Readout::moment;
  double rotation_deg = 0.;
  static constexpr std::size_t n_steps = 16;

  using Signal = std::function<double(double t_s)>;
  Signal base_velocity = [](double) { return 0.; };  // for the relative wind
  Signal warming = [](double) { return 0.; };        // change of the stiffness during a record
  /// Further moment of the joint, by x and x' / (2 pi frequency_hz).
  std::function<double(double x, double v)> further = nullptr;

  /// One Runge-Kutta step of x'' = slope(t, x, x').
  template <typename Slope>
  static void step(const Slope& slope, double t, double dt, double& x, double& v) {
    const double k1 = slope(t, x, v), v2 = v + 0.5 * dt * k1;
    const double k2 = slope(t + 0.5 * dt, x + 0.5 * dt * v, v2), v3 = v + 0.5 * dt * k2;
    const double k3 = slope(t + 0.5 * dt, x + 0.5 * dt * v2, v3), v4 = v + dt * k3;
    const double k4 = slope(t + dt, x + dt * v3, v4);
    x += dt / 6. * (v + 2. * v2 + 2. * v3 + v4);
    v += dt / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
  }

  signals::Record record(std::size_t n, double warm_up_s, const Signal& a, const Signal& u,
                         unsigned seed, bool with_wind) const {
    const double w = 2. * std::numbers::pi * frequency_hz, k0 = w * w,
                 c0 = 2. * damping_ratio * w * loss;
    const double dt = 1. / (rate_hz * n_steps);
    const double in_plane = std::cos(rotation_deg * std::numbers::pi / 180.);
    const auto elastic = [&](double t, double x, double v) {
      return k0 * ((stiffness + warming(t)) * x + cubic * x * x * x +
                   (further ? further(x, v / w) : 0.));
    };
    const auto slope = [&](double t, double x, double v) {
      const double wind = u(t) - own_motion * (v + base_velocity(t));
      return -elastic(t, x, v) - c0 * v + in_plane * (drag * wind * std::abs(wind) - a(t));
    };
    const double w2 = 2. * std::numbers::pi * extra_hz;
    const auto extra_slope = [&](double t, double y, double v) {
      return w2 * (w2 * (a(t) - y) - 0.04 * v);
    };
    const auto reading = [&](double t, double x, double v) {
      return readout == signals::Readout::rotation ? k0 * x : elastic(t, x, v) + c0 * v;
    };
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto lag = static_cast<std::size_t>(std::lround(delay_s / dt));
    std::deque<double> moments(lag + 1, 0.);
    std::vector<double> acceleration(n), moment(n), wind(n);
    double x = 0., v = 0., y = 0., y_rate = 0.;
    const auto warm = static_cast<long>(std::lround(warm_up_s / dt));
    const double phase = 6.28 * std::uniform_real_distribution<double>()(random);
    for (long i = -warm; i < static_cast<long>(n * n_steps); ++i) {
      const double t = static_cast<double>(i) * dt;
      moments.push_back(moment_mass * (reading(t, x, v) + extra_residue * y));
      moments.pop_front();
      if (i >= 0 && i % static_cast<long>(n_steps) == 0) {
        const auto j = static_cast<std::size_t>(i) / n_steps;
        acceleration[j] = a(t) + acceleration_noise * normal(random);
        moment[j] = moments.front() + moment_noise * normal(random) +
                    hum * std::sin(2. * std::numbers::pi * hum_hz * t + phase);
        wind[j] = u(t);
      }
      step(slope, t, dt, x, v);
      if (extra_residue != 0.) step(extra_slope, t, dt, y, y_rate);
    }
    signals::Record out(rate_hz, n);
    out.set_channel(signals::channel::base_acceleration, std::move(acceleration));
    out.set_channel(signals::channel::base_moment, std::move(moment));
    if (with_wind) out.set_channel(signals::channel::wind_speed, std::move(wind));
    return out;
  }
};

inline double no_signal(double) {
  return 0.;
}

/// Sines of equal amplitude and random phase, by angular frequency and phase.
template <typename Term>
OneModeRig::Signal sum_of_terms(const std::vector<double>& frequencies_hz, double level,
                                unsigned seed, const Term& term) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi);
  std::vector<double> phases(frequencies_hz.size());
  for (double& value : phases) value = phase(random);
  const double height = level * std::sqrt(2. / static_cast<double>(frequencies_hz.size()));
  return [=](double t) {
    double sum = 0.;
    for (std::size_t i = 0; i < phases.size(); ++i) {
      const double w = 2. * std::numbers::pi * frequencies_hz[i];
      sum += term(w, w * t + phases[i]);
    }
    return height * sum;
  };
}

/// Sum of sines of equal amplitude and random phase. Peak about level sqrt(2 n).
inline OneModeRig::Signal sines(const std::vector<double>& frequencies_hz, double level,
                                unsigned seed) {
  return sum_of_terms(frequencies_hz, level, seed,
                      [](double, double angle) { return std::sin(angle); });
}

/// The integral of the same sum, without mean.
inline OneModeRig::Signal integral_of_sines(const std::vector<double>& frequencies_hz, double level,
                                            unsigned seed) {
  return sum_of_terms(frequencies_hz, level, seed,
                      [](double w, double angle) { return -std::cos(angle) / w; });
}

/// Odd multiples of one line, every fourth of them left out.
inline std::vector<double> odd_lines_hz(double line_hz, double low_hz, double high_hz) {
  std::vector<double> out;
  for (int k = 1; k * line_hz <= high_hz; k += 2)
    if (k * line_hz >= low_hz && (k / 2) % 4 != 1) out.push_back(k * line_hz);
  return out;
}

/// For records that are not periodic.
inline std::vector<double> scattered_lines_hz() {
  std::vector<double> out;
  for (double f = 5.137; f < 110.; f += 3.3171) out.push_back(f);
  return out;
}

struct RigDatasetOptions {
  bool wind = false;
  bool quiet = true;
  bool held_out = true;
  double low_level = 1., high_level = 4.;  // rms, m/s^2
  unsigned seed = 7;
};

/// Two base records of two periods each at two levels; held out: one that does not repeat.
inline signals::Dataset rig_dataset(const OneModeRig& rig, const RigDatasetOptions& options = {}) {
  constexpr std::size_t period = 512;
  using signals::Split;
  signals::Dataset out;
  const std::vector<double> lines =
      odd_lines_hz(rig.rate_hz / static_cast<double>(period), 4., 120.);
  const auto add = [&](const std::string& name, const signals::Excitation& excitation,
                       std::size_t period_samples, Split split, const OneModeRig::Signal& a,
                       const OneModeRig::Signal& u, std::size_t n) {
    const unsigned seed = options.seed + 13 * static_cast<unsigned>(out.records.size());
    out.records.push_back({name,
                           rig.record(n, period_samples > 0 ? 4.096 : 0., a, u, seed, options.wind),
                           excitation,
                           period_samples,
                           split,
                           rig.readout,
                           {.rotation_deg = rig.rotation_deg}});
  };
  if (options.quiet) add("quiet", {}, 0, Split::fit, no_signal, no_signal, 1024);
  const unsigned seed = options.seed;
  add("base_low", {true, false}, period, Split::fit, sines(lines, options.low_level, seed + 1),
      no_signal, 2 * period);
  add("base_high", {true, false}, period, Split::fit, sines(lines, options.high_level, seed + 2),
      no_signal, 2 * period);
  const auto gusts = [&](unsigned number) {
    const auto moving = sines({0.31, 0.83, 1.7, 3.9, 7.3, 13.1, 24.7, 33.9, 36.3}, 0.5, number);
    return [moving](double t) { return 2. + moving(t); };
  };
  if (options.wind) add("wind", {false, true}, 0, Split::fit, no_signal, gusts(seed + 3), 1500);
  if (options.held_out)
    add("held_out", {true, options.wind}, 0, Split::held_out,
        sines(scattered_lines_hz(), 0.5 * (options.low_level + options.high_level), seed + 4),
        options.wind ? OneModeRig::Signal(gusts(seed + 5)) : no_signal, 2000);
  return out;
}

/// Nominal model of the rig without extras, from theory.
inline NominalModel nominal_of(const OneModeRig& rig, bool wind) {
  NominalModel model;
  StructuralMode mode{.frequency_rad_s = 2. * std::numbers::pi * rig.frequency_hz,
                      .damping_ratio = rig.damping_ratio,
                      .base_gain = -rig.moment_mass,
                      .base_rate = -2. * rig.damping_ratio * rig.moment_mass};
  if (wind) {
    mode.wind_gain = rig.moment_mass * rig.drag;
    mode.wind_rate = 2. * rig.damping_ratio * mode.wind_gain;
  }
  model.modes = {mode};
  model.has_base = true;
  model.has_wind = wind;
  model.base_misfit = model.wind_misfit = 1e-4;
  // The rig's only spring has the whole compliance.
  model.joint_share = 1.;
  model.joint_share_deviation = 0.02;
  return model;
}

inline OneModeRig noisy_rig() {
  OneModeRig rig;
  rig.moment_noise = 6e-7;
  rig.acceleration_noise = 0.05;
  return rig;
}

}  // namespace vibrissa::diagnosis::test
