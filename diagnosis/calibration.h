#pragma once

namespace vibrissa::diagnosis {

/// Share of their log odds that the best answers of fits earn in trials: of 1, fits are as often
/// right as they say.
inline constexpr double confidence_in_fits = 1.;

/// Odds against the best answer by trials, from those by the fits: odds^confidence. What is no
/// likelier than not stays as it is.
double calibrated_odds(double odds_against, double confidence = confidence_in_fits);

}  // namespace vibrissa::diagnosis
