#include "diagnosis/search/confidence_set.h"

#include <algorithm>

#include "diagnosis/model/hypothesis.h"

namespace vibrissa::diagnosis {

std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates,
                                        const double level) {
  std::vector<std::string> names;
  double sum = 0.;
  for (const Candidate& candidate : candidates) {
    if (sum >= level) break;
    names.push_back(candidate.name);
    sum += candidate.probability;
  }
  return names;
}

std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates,
                                        const double level, const double probability_of_tried,
                                        const double probability_of_outside) {
  std::vector<Candidate> answers;
  double total = probability_of_outside;
  for (const Candidate& candidate : candidates) {
    if (candidate.name == outside_catalogue) continue;
    answers.push_back(candidate);
    answers.back().probability *= probability_of_tried;
    total += answers.back().probability;
  }
  // The verdict stays first.
  auto index = answers.begin();
  if (candidates.front().name != outside_catalogue)
    index = std::find_if(index + 1, answers.end(), [&](const Candidate& candidate) {
      return candidate.probability < probability_of_outside;
    });
  answers.insert(index, {.name = outside_catalogue,
                         .fit = 0,
                         .calibrations = {},
                         .probability = probability_of_outside});
  return confidence_set(answers, level * total);
}

std::size_t n_known(const std::vector<std::string>& confidence_set) {
  return confidence_set.size() -
         static_cast<std::size_t>(
             std::count(confidence_set.begin(), confidence_set.end(), outside_catalogue));
}

}  // namespace vibrissa::diagnosis
