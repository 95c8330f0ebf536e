#include "diagnosis/validation/untested.h"

#include <algorithm>
#include <map>

#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {
namespace {

std::string reason_of(Lack lack) {
  switch (lack) {
    case Lack::wind:
      return "no usable fit record with wind";
    case Lack::base:
      return "no usable fit record with base motion";
    case Lack::cross:
      return "cross_acceleration_m_s2 is not measured";
    case Lack::modes:
      return "the simulation has no mode";
    case Lack::duration:
      return "the records with motion are too short";
    case Lack::band:
      return "the base does not move at its frequencies";
    case Lack::repeats:
      break;
  }
  return "";
}

}  // namespace

std::vector<UntestedEffect> untested_effects(const Experiment& experiment) {
  std::vector<UntestedEffect> out;
  for (const Effect& effect : effect_catalogue()) {
    const std::vector<Lack> lack = lacks(experiment, effect);
    const auto has = [&](Lack one) {
      return std::find(lack.begin(), lack.end(), one) != lack.end();
    };
    // Where no sample repeats, the effect is excluded and not untested.
    if (lack.empty() || has(Lack::repeats)) continue;
    out.push_back({effect.id, reason_of(has(Lack::wind) ? Lack::wind : lack.front())});
  }
  return out;
}

std::string untested_sentence(const std::vector<UntestedEffect>& untested) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const UntestedEffect& entry : untested) by_reason[entry.reason].push_back(entry.effect);
  std::vector<std::string> parts;
  for (const auto& [reason, effects] : by_reason)
    parts.push_back(joined(effects, ", ") + " (" + reason + ")");
  return joined(parts, "; ");
}

}  // namespace vibrissa::diagnosis
