#pragma once

namespace vibrissa::diagnosis {

/// Share of their log odds that the best answers of fits earn in trials of the nominal model itself
/// (of 1, fits would be as often right as they say): learnt by benchmarks/score_calibration, whose
/// seeds docs/diagnosis.md tells.
inline constexpr double confidence_in_fits = 0.6;

/// Odds against the best answer by trials, from those by the fits: odds^confidence. What is no
/// likelier than not stays as it is.
double calibrated_odds(double odds_against, double confidence = confidence_in_fits);

}  // namespace vibrissa::diagnosis
