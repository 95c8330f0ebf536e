#pragma once

#include <string>

namespace vibrissa::diagnosis {

/// Factor on the log odds of the best answer that calibrates them in trials with the nominal model
/// itself (1: the fits are calibrated). Determined by benchmarks/score_calibration;
/// docs/diagnosis.md gives the seeds.
inline constexpr double confidence_in_fits = 0.6;

/// Calibrated odds against the best answer from those by the fits: odds^confidence. Odds against of
/// 1 and more stay unchanged.
double calibrated_odds(double odds_against, double confidence = confidence_in_fits);

/// The effects of an answer beside wrong calibrations; "none" where there are none.
std::string without_calibrations(const std::string& answer);

/// Kind of an answer, by the number of its effects beside wrong calibrations.
enum class AnswerKind { none, single, several, outside };
AnswerKind answer_kind(const std::string& answer);

/// Probability that an answer of a kind is right in blind trials, given its probability p among all
/// tested answers: logit = offset + slope logit(p). It is less than p when the records may not show
/// the cause, or when the cause was not tested. Determined by `vibrissa trial score`;
/// docs/diagnosis.md gives the seeds.
struct Trust {
  double offset = 0., slope = 1.;
};
Trust trust_in(AnswerKind kind);

/// Share of the wrong answers of a kind whose true cause was outside the catalogue in blind trials.
double unknown_share(AnswerKind kind);

/// Logit of a probability, limited to probabilities between 1e-4 and 1 - 1e-4.
double log_odds(double probability);

/// Probability that any tested answer is right, when those with the effects of the best one have
/// the given probability among them; at most 1. Proven by
/// tests/diagnosis/search/calibrated_odds_test.cc.
double probability_of_tried(AnswerKind kind, double best);

}  // namespace vibrissa::diagnosis
