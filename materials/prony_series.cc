#include "materials/prony_series.h"

#include <cassert>
#include <cmath>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::materials {

PronySeries::PronySeries(std::vector<PronyBranch> branches) : branches_(std::move(branches)) {
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const auto& [ratio, time] = branches_[i];
    const std::string name = "Prony branch " + std::to_string(i + 1) + ": ";
    if (!(std::isfinite(ratio) && ratio >= 0.))
      throw signals::UserError(name + "modulus ratio is " + signals::to_text(ratio) +
                               "; it must be a finite number, zero or above");
    if (!(std::isfinite(time) && time > 0.))
      throw signals::UserError(name + "relaxation time is " + signals::to_text(time) +
                               " s; it must be a finite number above zero");
  }
}

PronySeries::Memory PronySeries::at_rest() const {
  return {Stress(), std::vector<Stress>(branches_.size())};
}

Stress PronySeries::advance(const IsochoricLaw& law, const Strain& strain, const double step_s,
                            Memory& memory) const {
  assert(memory.branches.size() == branches_.size());
  const Stress now = std::visit([&](const auto& kind) { return kind.stress(strain); }, law);
  const Stress change = now - memory.law;
  memory.law = now;
  Stress total = now;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    Stress& branch = memory.branches[i];
    branch = std::exp(-step_s / branches_[i].relaxation_time_s) * branch +
             gain(branches_[i], step_s) * change;
    total += branch;
  }
  return total;
}

double PronySeries::gain(const PronyBranch& branch, const double step_s) {
  const double x = step_s / branch.relaxation_time_s;
  return branch.modulus_ratio * (x == 0. ? 1. : -std::expm1(-x) / x);
}

double PronySeries::tangent_factor(const double step_s) const {
  double factor = 1.;
  for (const auto& branch : branches_) factor += gain(branch, step_s);
  return factor;
}

std::complex<double> PronySeries::dynamic_ratio(const double frequency_rad_s) const {
  std::complex<double> total = 1.;
  for (const auto& [ratio, time] : branches_) {
    const std::complex<double> turn(0., frequency_rad_s * time);
    total += ratio * turn / (1. + turn);
  }
  return total;
}

}  // namespace vibrissa::materials
