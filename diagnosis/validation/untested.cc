#include "diagnosis/validation/named_answers.h"

#include <algorithm>
#include <map>

#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {

std::vector<UntestedEffect> untested_effects(const Experiment& experiment) {
  // In the order of Lack. Where no sample repeats, the effect is excluded and not untested.
  constexpr const char* reasons[] = {"no usable fit record with base motion",
                                     "no usable fit record with wind",
                                     "cross_acceleration_m_s2 is not measured",
                                     "",
                                     "the simulation has no mode",
                                     "the records with motion are too short",
                                     "the base does not move at its frequencies",
                                     "responses to a sine do not show it; records in time do"};
  std::vector<UntestedEffect> out;
  for (const Effect& effect : effect_catalogue()) {
    const std::vector<Lack> lack = lacks(experiment, effect);
    if (lack.empty() || std::ranges::count(lack, Lack::repeats) > 0) continue;
    const Lack first = std::ranges::count(lack, Lack::wind) > 0 ? Lack::wind : lack.front();
    out.push_back({effect.id, reasons[static_cast<std::size_t>(first)]});
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
