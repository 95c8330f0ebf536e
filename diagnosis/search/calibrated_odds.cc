#include "diagnosis/search/calibrated_odds.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/model/hypothesis.h"

namespace vibrissa::diagnosis {

double calibrated_odds(const double odds_against, const double confidence) {
  return odds_against < 1. ? std::pow(odds_against, confidence) : odds_against;
}

AnswerKind answer_kind(const std::string& answer) {
  if (answer == "none") return AnswerKind::none;
  if (answer == outside_catalogue) return AnswerKind::outside;
  return effect_ids(answer).size() == 1 ? AnswerKind::single : AnswerKind::several;
}

Trust trust_in(const AnswerKind kind) {
  switch (kind) {
    case AnswerKind::none:
      return {-0.98, 1.00};
    case AnswerKind::single:
      return {-1.06, 0.94};
    case AnswerKind::several:
      return {-1.17, 0.56};
    case AnswerKind::outside:
      break;
  }
  // Right in 51 of 57 cases, independent of the stated probability; by the rule of succession.
  return {2.0, 0.};
}

double unknown_share(const AnswerKind kind) {
  switch (kind) {
    case AnswerKind::none:
      return 0.47;
    case AnswerKind::single:
      return 0.27;
    case AnswerKind::several:
      return 0.26;
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
