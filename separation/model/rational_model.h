#pragma once

#include <complex>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::separation {

/// One mode of the base vibration response, (b1 s + b0) / (s^2 + a1 s + a0), a0 = w^2, a1 = 2 zeta
/// w. The base moment has an elastic and a viscous part, hence b1. Every stable pair of poles is
/// possible, also two real poles (damping ratio above 1).
struct ModalTerm {
  double b1 = 0.;  // kg m / s
  double b0 = 0.;  // kg m / s^2
  double a1 = 0.;  // 1 / s
  double a0 = 0.;  // 1 / s^2

  double frequency_hz() const;      // undamped, sqrt(a0) / (2 pi)
  double damping_ratio() const;     // a1 / (2 sqrt(a0))
  double static_gain_kg_m() const;  // b0 / a0: moment per constant acceleration
};

/// The term with this undamped frequency, damping ratio and static gain; viscous_gain is b1.
ModalTerm make_modal_term(double frequency_hz, double damping_ratio, double static_gain_kg_m,
                          double viscous_gain_kg_m_s = 0.);

/// Whether the mode is stable and its damped free oscillation is below this angular frequency. Two
/// real poles do not oscillate.
bool is_stable_below(const ModalTerm& mode, double highest_rad_s);

/// Base vibration response model (BVRM): base moment per base acceleration,
///   G(s) = exp(-s delay) [ sum_k (b1_k s + b0_k) / (s^2 + a1_k s + a0_k) + D ]   [N m s^2/m = kg
///   m]
/// (Routray et al. 2024, eq. 12, with a finite sum and one direct term for the modes above the
/// band).
struct Bvrm {
  std::vector<ModalTerm> modes;
  double direct_term_kg_m = 0.;
  double delay_s = 0.;  // negative: the moment leads

  std::size_t order() const { return 2 * modes.size(); }  // number of poles
};

/// Throws UserError with the mode and the parameter unless every mode is stable and all parameters
/// are finite.
void check(const Bvrm& model);

/// G(j 2 pi f), convention exp(+j w t). Proven by tests/separation/model/rational_model_test.cc.
std::vector<std::complex<double>> response(const Bvrm& model, std::span<const double> frequency_hz);

/// {"schema": "vibrissa-bvrm-1", "modes": [{"frequency_hz", "damping_ratio", "b1_kg_m_per_s",
/// ...}],
///  "direct_term_kg_m", "delay_s"}. frequency_hz and damping_ratio are only for people.
nlohmann::json to_json(const Bvrm& model);
/// Throws UserError with the place (where, e.g. a file name, and the entry) for an entry that is
/// missing, unknown, of the wrong type, not finite, unstable, or for a frequency_hz or
/// damping_ratio that contradicts a0 and a1.
Bvrm bvrm_from_json(const nlohmann::json& json, const std::string& where);

}  // namespace vibrissa::separation
