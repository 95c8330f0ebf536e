#include "trial/classes/case_class.h"

#include <array>
#include <utility>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::trial {
namespace {

constexpr std::array<std::pair<CaseClass, const char*>, 9> names{{
    {CaseClass::single, "single"},
    {CaseClass::pair, "pair"},
    {CaseClass::triple, "triple"},
    {CaseClass::none, "none"},
    {CaseClass::calibration_only, "calibration_only"},
    {CaseClass::nameless, "nameless"},
    {CaseClass::left_out, "left_out"},
    {CaseClass::below_limit, "below_limit"},
    {CaseClass::wrong_metadata, "wrong_metadata"},
}};

}  // namespace

std::string to_string(const CaseClass kind) {
  return names[static_cast<std::size_t>(kind)].second;
}

CaseClass parse_case_class(const std::string& name) {
  if (name == "retune_only") return CaseClass::calibration_only;  // version 1
  std::vector<std::string> known;
  for (const auto& [kind, known_name] : names) {
    if (name == known_name) return kind;
    known.emplace_back(known_name);
  }
  throw signals::UserError(signals::unknown_name("class of a trial case", name, known));
}

}  // namespace vibrissa::trial
