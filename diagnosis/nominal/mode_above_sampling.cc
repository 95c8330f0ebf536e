#include "diagnosis/nominal/base_path_identification.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {
namespace {

using separation::ModalTerm;

/// A mode that oscillates, as r / (s - p) and the conjugate.
struct Pole {
  Complex p, r;
};

Pole pole_of(const ModalTerm& mode) {
  const Complex p(-0.5 * mode.a1, std::sqrt(mode.a0 - 0.25 * mode.a1 * mode.a1));
  return {p, (mode.b1 * p + mode.b0) / (p - std::conj(p))};
}

ModalTerm term_of(const Pole& pole) {
  return {.b1 = 2. * pole.r.real(),
          .b0 = -2. * (pole.r * std::conj(pole.p)).real(),
          .a1 = -2. * pole.p.real(),
          .a0 = std::norm(pole.p)};
}

/// Logarithm of the factor by which the damping ratio is outside its usual range.
double strangeness(const ModalTerm& mode, const ModalTerm& strongest) {
  return std::max(0., std::abs(std::log(mode.damping_ratio() / strongest.damping_ratio())) -
                          std::abs(std::log(mode.frequency_hz() / strongest.frequency_hz())));
}

/// The same samples with the pole at q.
Pole moved(const Pole& pole, const Complex q, const separation::Hold hold) {
  const Complex ratio = q / pole.p;
  return {q, pole.r * (hold == separation::Hold::zero_order ? ratio : ratio * ratio)};
}

/// The mode and its aliases, the lowest first: they have the same samples.
std::vector<ModalTerm> aliases(const ModalTerm& mode, const separation::Hold hold,
                               const double sampling_rate_hz) {
  constexpr int n_multiples = 4;
  const Pole pole = pole_of(mode), conjugate{std::conj(pole.p), std::conj(pole.r)};
  std::vector<ModalTerm> out{mode};
  for (int n = 1; n <= n_multiples; ++n)
    for (const Pole& from : {conjugate, pole}) {
      const Complex shift(0., 2. * std::numbers::pi * n * sampling_rate_hz);
      out.push_back(term_of(moved(from, from.p + shift, hold)));
    }
  return out;
}

}  // namespace

separation::Bvrm with_modes_above_sampling(const separation::Bvrm& model,
                                           const separation::Hold hold,
                                           const double sampling_rate_hz) {
  const double strange = std::log(2.);
  separation::Bvrm out = model;
  if (hold == separation::Hold::band_limited || model.modes.empty()) return out;
  const ModalTerm strongest = *std::ranges::max_element(
      model.modes, {}, [](const ModalTerm& mode) { return std::abs(mode.static_gain_kg_m()); });
  for (ModalTerm& mode : out.modes) {
    const bool is_in_band = mode.frequency_hz() < 0.5 * sampling_rate_hz;
    if (mode.damping_ratio() >= 1. || (is_in_band && strangeness(mode, strongest) <= strange))
      continue;
    // The static gain of what is not a mode.
    const double rest = out.direct_term_kg_m + mode.static_gain_kg_m();
    const auto unlikely = [&](const ModalTerm& alias) {
      return std::pair(std::max(strange, strangeness(alias, strongest)),
                       std::abs(rest - alias.static_gain_kg_m()));
    };
    mode = std::ranges::min(aliases(mode, hold, sampling_rate_hz), {}, unlikely);
    out.direct_term_kg_m = rest - mode.static_gain_kg_m();
  }
  return out;
}

}  // namespace vibrissa::diagnosis
