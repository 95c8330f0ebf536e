#include "trial/generator/gap_share.h"

#include "trial/generator/unexplained_change.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {
namespace {

/// The sensor with all its effects but one.
World without(const TrialCase& trial_case, const CaseEffect& removed) {
  World out = trial_case.plain;
  for (const CaseEffect& effect : trial_case.effects)
    if (&effect != &removed) find_unknown(effect.id).apply(out, effect.size, effect.shape);
  return out;
}

}  // namespace

double power_of(const std::vector<std::complex<double>>& lines) {
  double out = 0.;
  for (const std::complex<double>& line : lines) out += std::norm(line);
  return out;
}

std::vector<std::optional<double>> gap_shares(const TrialCase& trial_case) {
  std::vector<std::optional<double>> out;
  if (trial_case.effects.empty()) return out;
  World design;
  design.joint.scale = trial_case.plain.joint.scale;
  const UnexplainedChange change(design, trial_case.session);
  // With the wind that blows, whether it is measured or not.
  constexpr bool with_all_wind = true;
  const std::vector<std::complex<double>> gap = change.of(trial_case.world, with_all_wind);
  const double of_gap = power_of(gap);
  for (const CaseEffect& effect : trial_case.effects) {
    std::vector<std::complex<double>> back = change.of(without(trial_case, effect), with_all_wind);
    for (std::size_t i = 0; i < back.size(); ++i) back[i] -= gap[i];
    const bool has_share = of_gap > 0. && !find_unknown(effect.id).random;
    out.push_back(has_share ? std::optional(power_of(back) / of_gap) : std::nullopt);
  }
  return out;
}

}  // namespace vibrissa::trial
