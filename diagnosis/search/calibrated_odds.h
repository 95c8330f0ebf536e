#pragma once

#include <string>

namespace vibrissa::diagnosis {

/// Share of their log odds that the best answers of fits earn in trials of the nominal model itself
/// (of 1, fits would be as often right as they say): learnt by benchmarks/score_calibration, whose
/// seeds docs/diagnosis.md tells.
inline constexpr double confidence_in_fits = 0.6;

/// Odds against the best answer by trials, from those by the fits: odds^confidence. What is no
/// likelier than not stays as it is.
double calibrated_odds(double odds_against, double confidence = confidence_in_fits);

/// What an answer names; calibrations count as effects.
enum class AnswerKind { none, single, several, outside };
AnswerKind answer_kind(const std::string& answer);

/// How often an answer of a kind was right in blind trials, where its odds among all that was tried
/// say p: logit = offset + slope logit(p). It is less than p where something may be there that
/// these records do not show, or that was not tried. Learnt by `vibrissa trial score`, whose seeds
/// docs/diagnosis.md tells.
struct Trust {
  double offset = 0., slope = 1.;
};
Trust trust_in(AnswerKind kind);

/// Of what is left to a kind's answers to be wrong, the share behind which no known effect stood in
/// blind trials: learnt like their trust.
double unknown_share(AnswerKind kind);

/// Of a probability; beyond one in ten thousand, on either side, they tell no more.
double log_odds(double probability);

/// Probability that any answer that was tried is right, the best of them having the given one among
/// them; never more than 1. Proven by tests/diagnosis/search/calibrated_odds_test.cc.
double probability_of_tried(AnswerKind kind, double best);

}  // namespace vibrissa::diagnosis
