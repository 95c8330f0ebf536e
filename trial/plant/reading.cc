#include "trial/plant/reading.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "trial/plant/sampler.h"

namespace vibrissa::trial {
namespace {

constexpr double pi = std::numbers::pi;

/// Effects of the accelerometer's electronics before sampling.
std::vector<double> reference_signal(const World& world, const FineRecord& fine) {
  std::vector<double> out = fine.acceleration;
  const double h = 1. / fine.rate_hz;
  if (world.reference_highpass_hz > 0.) {
    const double keep = std::exp(-2. * pi * world.reference_highpass_hz * h);
    double last = 0., state = 0.;
    for (double& a : out) {
      state = keep * state + 0.5 * (1. + keep) * (a - last);
      last = a;
      a = state;
    }
  }
  if (world.cable_peak != 0.) {
    const double w = 2. * pi * 70.;
    double q = 0., p = 0.;
    for (double& a : out) {
      p += h * (a - w * w * q - 0.06 * w * p);
      q += h * p;
      a += world.cable_peak * 0.06 * w * p;
    }
  }
  for (double& a : out) a *= world.reference_gain;
  return out;
}

/// Additions and nonlinearity of the moment sensor's electronics.
std::vector<double> sensor_signal(const World& world, const Structure& structure,
                                  const FineRecord& fine, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double h = 1. / fine.rate_hz;
  std::vector<double> out = fine.moment;
  double walk = 0., phase = 2. * pi * std::uniform_real_distribution<double>()(random);
  double contact = 0., followed = out.front();
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = fine.first_s + static_cast<double>(i) * h;
    double m = out[i] + world.feedthrough * fine.acceleration[i] -
               world.cross_axis * structure.first_moment_kg_m * fine.across[i] +
               world.wind_pickup * fine.wind[i];
    if (world.field_curvature != 0.) {
      // Field of a dipole at a distance that decreases with the moment, with slope one at rest.
      const double e = world.field_curvature;
      m = (1. - std::pow(std::max(0.2, 1. + e * m), -3.)) / (3. * e);
    }
    contact = std::clamp(contact + 3. * std::sqrt(h) * normal(random), -1., 1.);
    m *= world.sensor_gain * (1. - world.loose_gain * (contact > 0.3 ? 1. : 0.));
    walk += world.walk * std::sqrt(h) * normal(random);
    phase += 2. * pi * world.hum_hz * h + 0.05 * std::sqrt(h) * normal(random);
    m += world.ramp * t + walk + world.hum * std::sin(phase);
    if (world.slew > 0.)
      m = followed = followed + std::clamp(m - followed, -world.slew * h, world.slew * h);
    out[i] = m;
  }
  return out;
}

/// White noise with a share of slow noise (AR(1), 5 Hz).
class Noise {
 public:
  Noise(double deviation, double colour, double rate_hz)
      : deviation_(deviation), colour_(colour), keep_(std::exp(-2. * pi * 5. / rate_hz)) {}
  double next(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    slow_ = keep_ * slow_ + std::sqrt(1. - keep_ * keep_) * normal(random);
    return deviation_ * (std::sqrt(1. - colour_) * normal(random) + std::sqrt(colour_) * slow_);
  }

 private:
  double deviation_, colour_, keep_, slow_ = 0.;
};

}  // namespace

signals::Record read_out(const World& world, const Structure& structure, const FineRecord& fine,
                         const std::size_t n, const double rate_hz, const std::uint64_t seed,
                         const Readings& readings) {
  std::mt19937_64 random(seed), sensor_random(seed + 1), clock_random(seed + 2);
  const std::vector<double> reference = reference_signal(world, fine);
  const std::vector<double> sensed = sensor_signal(world, structure, fine, sensor_random);
  const auto signal = [&](const std::vector<double>& values) {
    return FineSignal{values, fine.rate_hz, fine.first_s};
  };
  const std::vector<double> moment_at = moment_times(world, rate_hz, n);
  const std::vector<double> reference_at = acceleration_times(world, rate_hz, n, clock_random);
  const double quiet = readings.noise ? 1. : 0.;
  const double own = std::hypot(world.acceleration_noise * quiet, world.reference_noise);
  Noise moment_noise(world.moment_noise * quiet, world.noise_colour, rate_hz);
  Noise axial(own, world.noise_colour, rate_hz), cross(own, world.noise_colour, rate_hz);
  std::vector<double> a(n), across(n), wind(n), moment(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    // A repeated reading returns the same conversion including its noise.
    a[k] = k > 0 && reference_at[k] == reference_at[k - 1]
               ? a[k - 1]
               : signal(reference).at(reference_at[k]) + axial.next(random);
    across[k] = signal(fine.across).at(t) + cross.next(random);
    wind[k] = signal(fine.wind).at(t);
    moment[k] =
        signal(sensed).converted(moment_at[k], world.conversion_s) + moment_noise.next(random);
    if (world.step_size > 0.) moment[k] = world.step_size * std::round(moment[k] / world.step_size);
  }
  signals::Record out(rate_hz, n);
  out.set_channel(signals::channel::base_acceleration, std::move(a));
  out.set_channel(signals::channel::cross_acceleration, std::move(across));
  if (readings.wind) out.set_channel(signals::channel::wind_speed, std::move(wind));
  out.set_channel(signals::channel::base_moment, std::move(moment));
  return out;
}

}  // namespace vibrissa::trial
