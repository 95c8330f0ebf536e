#pragma once

#include <array>
#include <complex>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "signals/record/record.h"

namespace vibrissa::signals {

/// One mode of the sensor clamped at its base, mass-normalised (phi^T M phi = 1). Motion is
/// relative to the base; x, y, z are the base frame (z along the undeformed whisker).
struct ReducedMode {
  double frequency_hz = 0.;
  double damping_ratio = 0.;
  /// Gamma_d = phi^T M r_d, r_d the unit translation along d [√kg].
  std::array<double, 3> participation{};
  /// L_d = rot_d^T M phi, rot_d the unit rotation about axis d through the base centre [√kg·m].
  std::array<double, 3> moment_participation{};
};

/// Prescribed wind load of the sensor at rest, as tables over the wind speed u along the axial
/// direction. Force on mode k: coefficient(u) u |u|; the same for the static base moment.
/// Between the speeds the coefficient is interpolated linearly in u; beyond the ends it is
/// constant.
struct WindLoad {
  std::vector<double> speed_m_s;                          // ascending, may be negative
  std::vector<std::vector<double>> modal_coefficient;     // [speed][mode], √kg/m
  std::vector<std::array<double, 3>> moment_coefficient;  // [speed], N m / (m/s)^2
};

/// Relative change of each property of the model for a relative change of one physical parameter,
/// d(property)/property per d(parameter)/parameter.
struct Sensitivity {
  std::string parameter;  // e.g. "silicone_modulus"
  double nominal_value = 0.;
  std::string unit;
  std::vector<double> frequency;   // [mode]
  std::vector<double> base_gain;   // [mode], of moment_participation * participation, axial
  std::vector<double> wind_gain;   // [mode], of moment_participation * modal wind force
  double static_base_moment = 0.;  // of the quasi-static base moment per acceleration
  double static_wind_moment = 0.;
};

/// Modes plus static correction, for base acceleration a(t) and wind u(t):
///   q'' + 2 zeta w q' + w^2 q = -Gamma . a + g(u) u|u|
///   M = sum_k L_k (w_k^2 q_k + 2 zeta_k w_k q_k') + (J - sum_k L_k Gamma_k^T)(-a)
///       + (m(u) - sum_k L_k g_k(u)) u|u|
/// M: moment that the sensor exerts on the support about the base centre, elastic and viscous parts
/// together [N m]; the sums in brackets are the static remainder of the cut-off modes.
struct ReducedModel {
  std::string name;
  std::array<double, 3> axial_direction{1., 0., 0.};  // unit vector in the xy-plane
  std::vector<ReducedMode> modes;
  /// J[i][d] = rot_i^T M r_d: static moment about axis i per acceleration along d, sign reversed
  /// [kg m].
  std::array<std::array<double, 3>, 3> rigid_moment{};
  WindLoad wind;
  std::vector<Sensitivity> sensitivities;
  std::map<std::string, std::string> provenance;

  /// Transverse axis e_z x axial; the base moment is the component about it.
  std::array<double, 3> moment_axis() const;
};

/// Throws UserError that names the entry when a value is not finite or out of range, a list has the
/// wrong length, the wind speeds do not ascend, or the axial direction is not a unit vector in the
/// xy-plane.
void check(const ReducedModel& model);

/// Inputs on one uniform clock; linear between samples. Empty spans are zero.
struct ReducedInput {
  double sampling_rate_hz = 0.;
  std::size_t n_samples = 0;
  std::span<const double> base_acceleration{};   // axial, true motion [m/s^2]
  std::span<const double> cross_acceleration{};  // along e_z x axial [m/s^2]
  std::span<const double> wind_speed{};          // along the axial direction [m/s]
};

/// As check(model); also refuses a rate that is not positive and an input of the wrong length.
void check(const ReducedModel& model, const ReducedInput& input);

struct ReducedOutput {
  std::vector<double> base_moment;  // about e_z x axial [N m]
  std::vector<double>
      cross_moment;  // about -axial, so that +cross acceleration acts like +axial [N m]
};

/// Exact response at the samples to inputs that are linear between them (matrix exponential of each
/// mode, oscillator_step.h): no time-step error for the base path; for wind the modal force is
/// linear between samples. Starts at rest. Throws UserError for a model that check() refuses, a
/// rate that is not positive, an input of the wrong length, and wind on a model without wind load.
/// Proven by tests/signals/model/reduced_model_test.cc.
ReducedOutput simulate(const ReducedModel& model, const ReducedInput& input);

/// M / a (axial) at the given frequencies [N m s^2/m]; infinite at the frequency of an undamped
/// mode.
std::vector<std::complex<double>> base_response(const ReducedModel& model,
                                                std::span<const double> frequency_hz);

/// Static base moment in a steady wind [N m], about moment_axis(). Throws UserError when the model
/// has no wind load.
double steady_wind_moment(const ReducedModel& model, double speed_m_s);

/// Schema "vibrissa-model-1": each key ends in the unit of its value; the file reads back to
/// identical bits.
nlohmann::json to_json(const ReducedModel& model);
/// Throws UserError with the file and the entry (JSON pointer) when an entry is missing or has the
/// wrong type, and what check() throws. Proven by tests/signals/model/reduced_model_json_test.cc.
ReducedModel read_reduced_model(const std::filesystem::path& file);
void write_reduced_model(const std::filesystem::path& file, const ReducedModel& model);

}  // namespace vibrissa::signals
