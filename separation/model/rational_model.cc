#include "separation/model/rational_model.h"

#include <cmath>
#include <numbers>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

void require(bool good, std::size_t mode, const std::string& parameter, double value,
             const std::string& rule) {
  if (!good)
    throw signals::UserError("base vibration response model, mode " + std::to_string(mode + 1) +
                             ": " + parameter + " = " + signals::to_text(value) + " must be " +
                             rule);
}

}  // namespace

double ModalTerm::frequency_hz() const {
  return std::sqrt(a0) / (2. * std::numbers::pi);
}

double ModalTerm::damping_ratio() const {
  return a1 / (2. * std::sqrt(a0));
}

double ModalTerm::static_gain_kg_m() const {
  return b0 / a0;
}

ModalTerm make_modal_term(double frequency_hz, double damping_ratio, double static_gain_kg_m,
                          double viscous_gain_kg_m_s) {
  const double omega = 2. * std::numbers::pi * frequency_hz;
  return {.b1 = viscous_gain_kg_m_s,
          .b0 = static_gain_kg_m * omega * omega,
          .a1 = 2. * damping_ratio * omega,
          .a0 = omega * omega};
}

bool is_stable_below(const ModalTerm& mode, const double highest_rad_s) {
  if (!(mode.a1 > 0. && mode.a0 > 0.)) return false;
  return mode.a0 - 0.25 * mode.a1 * mode.a1 < highest_rad_s * highest_rad_s;
}

void check(const Bvrm& model) {
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const ModalTerm& mode = model.modes[k];
    require(std::isfinite(mode.a0) && mode.a0 > 0., k, "a0", mode.a0, "positive and finite");
    require(std::isfinite(mode.a1) && mode.a1 > 0., k, "a1", mode.a1,
            "positive and finite (a stable mode)");
    require(std::isfinite(mode.b1), k, "b1", mode.b1, "finite");
    require(std::isfinite(mode.b0), k, "b0", mode.b0, "finite");
  }
  if (!std::isfinite(model.direct_term_kg_m) || !std::isfinite(model.delay_s))
    throw signals::UserError(
        "base vibration response model: direct_term_kg_m and delay_s must be finite");
}

std::vector<std::complex<double>> response(const Bvrm& model,
                                           std::span<const double> frequency_hz) {
  check(model);
  std::vector<std::complex<double>> values;
  values.reserve(frequency_hz.size());
  for (const double f : frequency_hz) {
    const std::complex<double> s(0., 2. * std::numbers::pi * f);
    std::complex<double> sum = model.direct_term_kg_m;
    for (const ModalTerm& mode : model.modes)
      sum += (mode.b1 * s + mode.b0) / (s * s + mode.a1 * s + mode.a0);
    values.push_back(sum * std::exp(-s * model.delay_s));
  }
  return values;
}

}  // namespace vibrissa::separation
