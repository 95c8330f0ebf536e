#include "diagnosis/search/calibrated_odds.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/model/hypothesis.h"

namespace vibrissa::diagnosis {

double calibrated_odds(const double odds_against, const double confidence) {
  return odds_against < 1. ? std::pow(odds_against, confidence) : odds_against;
}

std::string without_calibrations(const std::string& answer) {
  std::vector<std::string> ids = effect_ids(answer);
  std::erase_if(ids, [](const std::string& id) {
    const Effect* effect = effect_or_none(id);
    return effect != nullptr && effect->calibration;
  });
  return joined_name(std::move(ids));
}

AnswerKind answer_kind(const std::string& answer) {
  if (answer == outside_catalogue) return AnswerKind::outside;
  const std::size_t n = effect_ids(without_calibrations(answer)).size();
  return n == 0 ? AnswerKind::none : n == 1 ? AnswerKind::single : AnswerKind::several;
}

Trust trust_in(const AnswerKind kind) {
  // Where the stated probability told nothing, by the rule of succession: right in 47 of 70, 1 of
  // 3 and 3 of 5 answers.
  switch (kind) {
    case AnswerKind::none:
      return {0.69, 0.};
    case AnswerKind::single:
      return {-0.41, 0.15};
    case AnswerKind::several:
      return {-0.41, 0.};
    case AnswerKind::outside:
      break;
  }
  return {0.29, 0.};
}

double unknown_share(const AnswerKind kind) {
  switch (kind) {
    case AnswerKind::none:
      return 0.32;  // 7 of 23
    case AnswerKind::single:
    case AnswerKind::several:
      return 0.24;  // 3 of 15
    case AnswerKind::outside:
      break;
  }
  return 0.;
}

double log_odds(const double probability) {
  constexpr double surest = 1. - 1e-4;
  const double p = std::clamp(probability, 1. - surest, surest);
  return std::log(p / (1. - p));
}

double probability_of_tried(const AnswerKind kind, const double best) {
  const Trust trust = trust_in(kind);
  const double logit = trust.offset + trust.slope * log_odds(best);
  return std::min(1., 1. / (1. + std::exp(-logit)) / best);
}

}  // namespace vibrissa::diagnosis
