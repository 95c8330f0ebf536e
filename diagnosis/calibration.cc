#include "diagnosis/calibration.h"

#include <cmath>

namespace vibrissa::diagnosis {

double calibrated_odds(const double odds_against, const double confidence) {
  return odds_against < 1. ? std::pow(odds_against, confidence) : odds_against;
}

}  // namespace vibrissa::diagnosis
