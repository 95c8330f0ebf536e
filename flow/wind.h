#pragma once

#include <deal.II/base/parameter_handler.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flow/drag_law.h"
#include "flow/wind_profile.h"

namespace vibrissa::flow {

enum class WindKind { none, steady, sines, turbulent, recorded };

/// Surface on which the wind pressure acts at finite strain: area and normal of the undeformed
/// surface, or of the deformed surface.
enum class PressureSurface { reference, deformed };

/// Subsection "Wind" of the case file: the wind along the axial direction, and the air. A negative
/// mean speed is directed towards -x.
struct WindParameters {
  WindKind kind = WindKind::turbulent;
  double mean_speed = 2.;                     // m/s
  std::vector<double> sine_frequency_hz{5.};  // "sines" adds sines of these frequencies to the mean
  std::vector<double> sine_amplitude{1.};     // m/s, of sin(2 pi f t + phase)
  std::vector<double> sine_phase_deg{0.};
  double turbulence_intensity = 0.2;  // standard deviation / |mean|
  double length_scale = 0.1;          // m, longitudinal integral scale
  double maximum_speed = 4.;          // m/s, turbulent wind is clipped to ± this value
  WindProfile profile = WindProfile::uniform;
  PressureSurface pressure_surface = PressureSurface::deformed;  // linear models: reference
  bool relative_velocity = false;  // drag of the air speed relative to the moving whisker
  Air air;

  /// Names, units and ranges; deal.II refuses a value out of range with its line in the case file.
  static void declare(dealii::ParameterHandler& prm);
  /// Reads all entries and ends with check().
  void parse(dealii::ParameterHandler& prm);
  /// Throws UserError naming the entries: lists of unequal length, frequencies not positive, sines
  /// without a sine, turbulence without a mean, a mean above the clipping speed, air without
  /// density or viscosity, values that are not finite.
  void check() const;
};

/// Wind speed at the reference height (profile factor 1), uniformly sampled from t = 0 [m/s]. none:
/// zero. steady: the mean. sines: mean + sum amplitude sin(2 pi f t + phase). turbulent: Gaussian,
/// von Karman's longitudinal density, synthesised at the lines k/T of the record, 0 < k/T <=
/// rate/2, by random phases and Rayleigh amplitudes from the seed. The record is therefore one
/// period with exact mean, without the variance below 1/(2T) and above rate/2. Clipping to
/// ±maximum_speed is the last step (clipped samples equal this bound exactly and can be counted;
/// they change mean and variance). The same seed gives the same wind. The caller reads recorded
/// wind (assert). Throws UserError as check() does, and when a sine is at or above half the
/// sampling rate. Proven by tests/flow/wind_test.cc.
std::vector<double> make_wind(const WindParameters& wind, double sampling_rate_hz,
                              std::size_t n_samples, std::uint64_t seed);

/// One-sided von Karman density [m^2/s^2/Hz] at n [Hz] >= 0: n S(n)/sigma^2 =
/// 4 x / (1 + 70.8 x^2)^(5/6), x = n L/|U| (shape: von Karman 1948; constants: ESDU 85020).
/// Integrates to 0.99986 sigma^2. Proven by wind_test.cc, VonKarmanDensity.
double von_karman_density(double frequency_hz, double mean_speed, double standard_deviation,
                          double length_scale);

}  // namespace vibrissa::flow
