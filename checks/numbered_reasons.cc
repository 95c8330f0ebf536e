#include "checks/numbered_reasons.h"

#include <algorithm>

namespace vibrissa::checks {
namespace {

std::vector<std::string> all_reasons(const CheckResult& result) {
  std::vector<std::string> all;
  for (const CommandVerdict& verdict : result.serves)
    for (const std::string& reason : verdict.reasons)
      if (std::ranges::find(all, reason) == all.end()) all.push_back(reason);
  return all;
}

}  // namespace

NumberedReasons::NumberedReasons(const CheckResult& result) {
  const std::vector<std::string> reasons = all_reasons(result);
  for (std::size_t r = 0; r < result.records.size(); ++r)
    for (std::size_t f = 0; f < result.records[r].findings.size(); ++f) {
      const std::string& sentence = result.records[r].findings[f].sentence;
      const Entry entry{r, f, sentence, result.records[r].name + ": " + sentence};
      const auto cites = [&](const std::string& reason) { return entry.is(reason); };
      if (std::ranges::any_of(reasons, cites)) findings_.push_back(entry);
    }
  std::size_t number = findings_.size();
  for (const std::string& reason : reasons) {
    const auto cited = [&](const Entry& entry) { return entry.is(reason); };
    if (std::ranges::none_of(findings_, cited)) others_.emplace_back(++number, reason);
  }
}

std::optional<std::size_t> NumberedReasons::of_finding(const std::size_t record,
                                                       const std::size_t finding) const {
  for (std::size_t i = 0; i < findings_.size(); ++i)
    if (findings_[i].record == record && findings_[i].finding == finding) return i + 1;
  return std::nullopt;
}

std::size_t NumberedReasons::number_of(const std::string& reason) const {
  for (std::size_t i = 0; i < findings_.size(); ++i)
    if (findings_[i].is(reason)) return i + 1;
  for (const auto& [number, sentence] : others_)
    if (sentence == reason) return number;
  return 0;
}

std::string NumberedReasons::of_command(const CommandVerdict& verdict) const {
  std::vector<std::size_t> numbers;
  for (const std::string& reason : verdict.reasons) numbers.push_back(number_of(reason));
  std::ranges::sort(numbers);
  std::string text;
  for (const std::size_t number : numbers)
    text += (text.empty() ? "[" : " [") + std::to_string(number) + "]";
  return text;
}

}  // namespace vibrissa::checks
