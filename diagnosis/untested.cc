#include "diagnosis/untested.h"

#include <map>

#include "diagnosis/words.h"

namespace vibrissa::diagnosis {
namespace {

std::string reason_of(const Experiment& experiment, const Effect& effect) {
  if (effect.needs.wind && !experiment.has_wind) return "no usable fit record with wind";
  if (effect.needs.base && !experiment.has_base) return "no usable fit record with base motion";
  if (effect.needs.cross && !experiment.has_cross) return "no cross_acceleration_m_s2";
  if (experiment.nominal.modes.empty()) return "the simulation has no mode";
  return "too few seconds of motion";
}

}  // namespace

std::vector<UntestedEffect> untested_effects(const Experiment& experiment) {
  std::vector<UntestedEffect> out;
  for (const Effect& effect : effect_catalogue())
    // Where no sample repeats, the count of equal neighbours has told.
    if (!shows(experiment, effect) && (!effect.needs.repeats || experiment.has_repeats))
      out.push_back({effect.id, reason_of(experiment, effect)});
  return out;
}

std::string untested_sentence(const std::vector<UntestedEffect>& untested) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const UntestedEffect& entry : untested) by_reason[entry.reason].push_back(entry.effect);
  std::vector<std::string> parts;
  for (const auto& [reason, effects] : by_reason)
    parts.push_back(reason + ": " + joined(effects, ", "));
  return joined(parts, "; ");
}

}  // namespace vibrissa::diagnosis
