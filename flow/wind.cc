#include "flow/wind.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/fft.h"

namespace vibrissa::flow {

namespace {

using dealii::ParameterHandler;
using signals::to_text;
using signals::UserError;
namespace Patterns = dealii::Patterns;
namespace Utilities = dealii::Utilities;

constexpr std::array kind_names{"none", "steady", "sines", "turbulent", "recorded"};
constexpr std::array profile_names{"uniform", "parabolic"};
constexpr std::array surface_names{"reference", "deformed"};

template <typename Names>
std::string selection(const Names& names) {
  std::string all;
  for (const std::string name : names) all += (all.empty() ? "" : "|") + name;
  return all;
}

/// The enumerator with this name; the declared selection refuses other names.
template <typename Enum, typename Names>
Enum enumerator(const Names& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  assert(found != names.end());
  return static_cast<Enum>(found - names.begin());
}

template <typename Names, typename Enum>
std::string name_of(const Names& names, const Enum value) {
  return names[static_cast<std::size_t>(value)];
}

std::string text(const std::vector<double>& values) {
  std::string all;
  for (const double value : values) all += (all.empty() ? "" : ", ") + to_text(value);
  return all;
}

std::vector<double> get_list(const ParameterHandler& prm, const std::string& entry) {
  return Utilities::string_to_double(Utilities::split_string_list(prm.get(entry)));
}

[[noreturn]] void refuse(const std::string& what) {
  throw UserError("subsection Wind: " + what);
}

void require(const bool holds, const std::string& entry, const double value,
             const std::string& unit, const std::string& condition) {
  if (!(std::isfinite(value) && holds))
    refuse(entry + " is " + to_text(value) + unit + "; it must be " + condition);
}

void check_sines(const WindParameters& wind) {
  const auto n = wind.sine_frequency_hz.size();
  if (wind.sine_amplitude.size() != n || wind.sine_phase_deg.size() != n)
    refuse("Sine frequencies, Sine amplitudes and Sine phases have " + std::to_string(n) + ", " +
           std::to_string(wind.sine_amplitude.size()) + " and " +
           std::to_string(wind.sine_phase_deg.size()) +
           " values; give one frequency, one amplitude and one phase for each sine");
  if (wind.kind == WindKind::sines && n == 0)
    refuse("Kind is sines, but Sine frequencies is empty; give a frequency or set Kind = steady");
  for (const double f : wind.sine_frequency_hz)
    require(f > 0., "Sine frequencies", f, " Hz", "above zero");
  for (const double a : wind.sine_amplitude)
    require(true, "Sine amplitudes", a, " m/s", "a finite number");
  for (const double phase : wind.sine_phase_deg)
    require(true, "Sine phases", phase, " degrees", "a finite number");
}

void check_turbulence(const WindParameters& wind) {
  require(wind.turbulence_intensity >= 0., "Turbulence intensity", wind.turbulence_intensity, "",
          "zero or above");
  require(wind.length_scale > 0., "Length scale", wind.length_scale, " m", "above zero");
  require(wind.maximum_speed > 0., "Maximum speed", wind.maximum_speed, " m/s", "above zero");
  if (wind.kind != WindKind::turbulent) return;
  require(
      wind.mean_speed != 0., "Mean speed", wind.mean_speed, " m/s",
      "other than zero for turbulent wind, because its strength and its time scale depend on it");
  require(std::abs(wind.mean_speed) < wind.maximum_speed, "Mean speed", wind.mean_speed, " m/s",
          "below Maximum speed (" + to_text(wind.maximum_speed) +
              " m/s), at which turbulent wind is clipped; raise Maximum speed or lower Mean speed");
}

std::vector<double> sines(const WindParameters& wind, const double sampling_rate_hz,
                          const std::size_t n_samples) {
  std::vector<double> speed(n_samples, wind.mean_speed);
  for (std::size_t s = 0; s < wind.sine_frequency_hz.size(); ++s) {
    const double frequency_hz = wind.sine_frequency_hz[s];
    if (frequency_hz >= 0.5 * sampling_rate_hz)
      refuse("Sine frequencies contains " + to_text(frequency_hz) +
             " Hz, which is not below half the sampling rate of " + to_text(sampling_rate_hz) +
             " Hz; lower the frequency or raise the sampling rate");
    const double step = 2. * std::numbers::pi * frequency_hz / sampling_rate_hz;
    const double phase = wind.sine_phase_deg[s] * std::numbers::pi / 180.;
    for (std::size_t i = 0; i < n_samples; ++i)
      speed[i] += wind.sine_amplitude[s] * std::sin(step * static_cast<double>(i) + phase);
  }
  return speed;
}

/// Unit variance in each part: Rayleigh modulus, uniform phase (Box and Muller). Written out
/// because std::normal_distribution may give other numbers with another standard library.
std::complex<double> complex_gaussian(std::mt19937_64& random) {
  const auto uniform = [&random] { return 0x1p-53 * static_cast<double>(random() >> 11); };
  const double modulus = std::sqrt(-2. * std::log1p(-uniform()));
  return std::polar(modulus, 2. * std::numbers::pi * uniform());
}

std::vector<double> turbulence(const WindParameters& wind, const double sampling_rate_hz,
                               const std::size_t n_samples, const std::uint64_t seed) {
  const double n = static_cast<double>(n_samples);
  const double resolution_hz = sampling_rate_hz / n;
  const double deviation = wind.turbulence_intensity * std::abs(wind.mean_speed);
  signals::RealFft fft(n_samples);
  std::mt19937_64 random(seed);
  const auto spectrum = fft.spectrum();
  spectrum[0] = 0.;
  for (std::size_t k = 1; k < spectrum.size(); ++k) {
    const double density = von_karman_density(static_cast<double>(k) * resolution_hz,
                                              wind.mean_speed, deviation, wind.length_scale);
    spectrum[k] = 0.5 * n * std::sqrt(density * resolution_hz) * complex_gaussian(random);
  }
  // The line at half the rate is real and has half the width of a line.
  if (n_samples % 2 == 0)
    spectrum[n_samples / 2] = std::numbers::sqrt2 * spectrum[n_samples / 2].real();
  fft.inverse();
  std::vector<double> speed(n_samples);
  std::transform(fft.time().begin(), fft.time().end(), speed.begin(), [&wind](const double u) {
    return std::clamp(wind.mean_speed + u, -wind.maximum_speed, wind.maximum_speed);
  });
  return speed;
}

}  // namespace

void WindParameters::declare(ParameterHandler& prm) {
  const WindParameters nominal;
  using Patterns::Double, Patterns::List, Patterns::Selection;
  prm.enter_subsection("Wind");
  prm.declare_entry(
      "Kind", name_of(kind_names, nominal.kind), Selection(selection(kind_names)),
      "none: still air. steady: Mean speed. sines: Mean speed plus the sines. turbulent: von "
      "Karman turbulence about Mean speed. recorded: the recording of the subsection Recorded.");
  prm.declare_entry("Mean speed", to_text(nominal.mean_speed), Double(-100., 100.),
                    "Mean wind speed along the axial direction [m/s].");
  prm.declare_entry("Sine frequencies", text(nominal.sine_frequency_hz), List(Double(0., 1e6)),
                    "Frequencies of the sines [Hz], above zero and below half the sampling rate.");
  prm.declare_entry("Sine amplitudes", text(nominal.sine_amplitude), List(Double(-100., 100.)),
                    "Amplitude of each sine [m/s].");
  prm.declare_entry("Sine phases", text(nominal.sine_phase_deg), List(Double(-1e4, 1e4)),
                    "Phase of each sine at time zero [degrees], of sin(2 pi f t + phase).");
  prm.declare_entry("Turbulence intensity", to_text(nominal.turbulence_intensity), Double(0., 1.),
                    "Standard deviation of the turbulent speed, divided by the mean speed [1].");
  prm.declare_entry("Length scale", to_text(nominal.length_scale), Double(1e-4, 1e4),
                    "Longitudinal integral length scale of the turbulence [m].");
  prm.declare_entry("Maximum speed", to_text(nominal.maximum_speed), Double(1e-3, 200.),
                    "Turbulent wind is clipped to plus or minus this speed [m/s].");
  prm.declare_entry("Profile", name_of(profile_names, nominal.profile),
                    Selection(selection(profile_names)),
                    "Speed over height: uniform, or parabolic from zero at the support to the full "
                    "speed at the tip.");
  prm.declare_entry(
      "Pressure acts on", name_of(surface_names, nominal.pressure_surface),
      Selection(selection(surface_names)),
      "Surface on which the pressure acts at finite strain: area and normal are those of the "
      "reference state or of the deformed state. Linear models always use the reference state.");
  prm.declare_entry("Relative velocity", nominal.relative_velocity ? "true" : "false",
                    Patterns::Bool(),
                    "Whether the drag depends on the air speed relative to the moving whisker, u - "
                    "v, instead of u; wind and vibration then interact. Full-order solid only.");
  prm.declare_entry("Air density", to_text(nominal.air.density), Double(1e-3, 100.),
                    "Density of the air [kg/m^3]; 1.204 at 20 C and sea level.");
  prm.declare_entry("Air kinematic viscosity", to_text(nominal.air.kinematic_viscosity),
                    Double(1e-8, 1.), "Kinematic viscosity of the air [m^2/s]; 1.51e-5 at 20 C.");
  prm.leave_subsection();
}

void WindParameters::parse(ParameterHandler& prm) {
  prm.enter_subsection("Wind");
  kind = enumerator<WindKind>(kind_names, prm.get("Kind"));
  mean_speed = prm.get_double("Mean speed");
  sine_frequency_hz = get_list(prm, "Sine frequencies");
  sine_amplitude = get_list(prm, "Sine amplitudes");
  sine_phase_deg = get_list(prm, "Sine phases");
  turbulence_intensity = prm.get_double("Turbulence intensity");
  length_scale = prm.get_double("Length scale");
  maximum_speed = prm.get_double("Maximum speed");
  profile = enumerator<WindProfile>(profile_names, prm.get("Profile"));
  pressure_surface = enumerator<PressureSurface>(surface_names, prm.get("Pressure acts on"));
  relative_velocity = prm.get_bool("Relative velocity");
  air.density = prm.get_double("Air density");
  air.kinematic_viscosity = prm.get_double("Air kinematic viscosity");
  prm.leave_subsection();
  check();
}

void WindParameters::check() const {
  require(true, "Mean speed", mean_speed, " m/s", "a finite number");
  check_sines(*this);
  check_turbulence(*this);
  require(air.density > 0., "Air density", air.density, " kg/m^3", "above zero");
  require(air.kinematic_viscosity > 0., "Air kinematic viscosity", air.kinematic_viscosity,
          " m^2/s", "above zero");
}

std::vector<double> make_wind(const WindParameters& wind, const double sampling_rate_hz,
                              const std::size_t n_samples, const std::uint64_t seed) {
  assert(wind.kind != WindKind::recorded);
  assert(sampling_rate_hz > 0.);
  wind.check();
  if (wind.kind == WindKind::sines) return sines(wind, sampling_rate_hz, n_samples);
  if (wind.kind == WindKind::turbulent && n_samples > 1)
    return turbulence(wind, sampling_rate_hz, n_samples, seed);
  return std::vector<double>(n_samples, wind.kind == WindKind::none ? 0. : wind.mean_speed);
}

double von_karman_density(const double frequency_hz, const double mean_speed,
                          const double standard_deviation, const double length_scale) {
  assert(frequency_hz >= 0. && mean_speed != 0. && length_scale > 0.);
  const double eddy_time = length_scale / std::abs(mean_speed);
  const double x = frequency_hz * eddy_time;
  return standard_deviation * standard_deviation * 4. * eddy_time /
         std::pow(1. + 70.8 * x * x, 5. / 6.);
}

}  // namespace vibrissa::flow
