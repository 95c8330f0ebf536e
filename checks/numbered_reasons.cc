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

bool NumberedReasons::Entry::is(const std::string& reason) const {
  return reason == sentence || std::ranges::find(with_name, reason) != with_name.end();
}

NumberedReasons::NumberedReasons(const CheckResult& result) {
  const std::vector<std::string> reasons = all_reasons(result);
  const auto is_cited = [&](const std::string& text) {
    return std::ranges::find(reasons, text) != reasons.end();
  };
  for (std::size_t r = 0; r < result.records.size(); ++r)
    for (std::size_t f = 0; f < result.records[r].findings.size(); ++f) {
      const std::string& sentence = result.records[r].findings[f].sentence;
      const std::string with_name = result.records[r].name + ": " + sentence;
      auto entry = std::ranges::find(findings_, sentence, &Entry::sentence);
      if (entry == findings_.end()) {
        if (!is_cited(sentence) && !is_cited(with_name)) continue;
        entry = findings_.insert(entry, Entry{sentence, {}, {}});
      }
      entry->with_name.push_back(with_name);
      entry->places.emplace_back(r, f);
    }
  std::size_t number = findings_.size();
  for (const std::string& reason : reasons) {
    const auto cited = [&](const Entry& entry) { return entry.is(reason); };
    if (std::ranges::none_of(findings_, cited)) others_.emplace_back(++number, reason);
  }
}

std::optional<std::size_t> NumberedReasons::of_finding(const std::size_t record,
                                                       const std::size_t finding) const {
  const std::pair place{record, finding};
  for (std::size_t i = 0; i < findings_.size(); ++i)
    if (std::ranges::find(findings_[i].places, place) != findings_[i].places.end()) return i + 1;
  return std::nullopt;
}

bool NumberedReasons::is_repeated(const std::size_t record, const std::size_t finding) const {
  const auto number = of_finding(record, finding);
  return number && findings_[*number - 1].places.front() != std::pair{record, finding};
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
  numbers.erase(std::ranges::unique(numbers).begin(), numbers.end());
  std::string text;
  for (const std::size_t number : numbers)
    text += (text.empty() ? "[" : " [") + std::to_string(number) + "]";
  return text;
}

}  // namespace vibrissa::checks
