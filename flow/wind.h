#pragma once

#include <deal.II/base/parameter_handler.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flow/drag_law.h"
#include "flow/wind_profile.h"

namespace vibrissa::flow {

enum class WindKind { none, steady, sines, turbulent, recorded };

/// Where the wind's pressure acts on a solid of finite strain: on the area and along the normal of
/// the undeformed surface, or of the current one.
enum class PressureSurface { reference, deformed };

/// The case file's subsection "Wind": what blows along the axial direction, and the air. A negative
/// mean blows towards -x.
struct WindParameters {
  WindKind kind = WindKind::turbulent;
  double mean_speed = 2.;                     // m/s
  std::vector<double> sine_frequency_hz{5.};  // "sines" adds these to the mean; one = a sine
  std::vector<double> sine_amplitude{1.};     // m/s, of sin(2 pi f t + phase)
  std::vector<double> sine_phase_deg{0.};
  double turbulence_intensity = 0.2;  // standard deviation / |mean|
  double length_scale = 0.1;          // m, longitudinal integral scale
  double maximum_speed = 4.;          // m/s, turbulent wind is clipped to +- this
  WindProfile profile = WindProfile::uniform;
  PressureSurface pressure_surface = PressureSurface::deformed;  // linear models: reference
  bool relative_velocity = false;  // drag of the air's speed past the moving whisker
  Air air;

  /// Names, units and ranges; deal.II refuses a value out of range with its line in the case file.
  static void declare(dealii::ParameterHandler& prm);
  /// Reads all entries and ends with check().
  void parse(dealii::ParameterHandler& prm);
  /// Throws UserError naming the entries: lists of unequal length, frequencies not positive, sines
  /// without a sine, turbulence without a mean, a mean that the clipping would remove, air without
  /// density or viscosity, anything not finite.
  void check() const;
};

/// Wind speed at the reference (profile factor 1) on a uniform clock from t = 0 [m/s].
/// none: zero. steady: the mean. sines: mean + sum amplitude sin(2 pi f t + phase).
/// turbulent: Gaussian, von Karman's longitudinal density, synthesised on the record's lines k/T,
/// 0 < k/T <= rate/2, by random phases and Rayleigh amplitudes from the seed. So the record is one
/// period, its mean is exact, and it lacks the variance below 1/(2T) and above rate/2. Clipping to
/// +-maximum_speed comes last (clipped samples equal that bound exactly and can be counted; they
/// shift mean and variance). The same seed gives the same wind.
/// recorded is the caller's affair (assert). Throws UserError as check() does, and when a sine is
/// at or above half the sampling rate. Proven by tests/flow/wind_test.cc.
std::vector<double> make_wind(const WindParameters& wind, double sampling_rate_hz,
                              std::size_t n_samples, std::uint64_t seed);

/// One-sided von Karman density [m^2/s^2/Hz] at n [Hz] >= 0: n S(n)/sigma^2 =
/// 4 x / (1 + 70.8 x^2)^(5/6), x = n L/|U| (von Karman 1948; ESDU 85020). Integrates to
/// 0.99986 sigma^2. Proven by wind_test.cc, VonKarmanDensity.
double von_karman_density(double frequency_hz, double mean_speed, double standard_deviation,
                          double length_scale);

}  // namespace vibrissa::flow
