#pragma once

#include <complex>
#include <vector>

#include "trial/generator/session.h"
#include "trial/plant/structure.h"

namespace vibrissa::trial {

/// Solved structures are kept: few worlds differ in their solid.
const Structure& structure_of(const SolidChange& change);

/// What a world adds to the moment of the plain one beyond what the measured base motion predicts,
/// on the lines of the fit takes: take after take, bins 1 .. n/2 - 1 each. Free of noise; the plain
/// sensor is measured once. Proven by tests/trial/generator/detection_limit_test.cc.
class UnexplainedChange {
 public:
  UnexplainedChange(const World& plain, const Session& session);

  const World& plain() const { return plain_; }
  /// Unscaled DFT [N m].
  std::vector<std::complex<double>> of(const World& world) const;
  /// Its variance [(N m)^2] where both channels have white noise of these deviations [N m, m/s^2].
  std::vector<double> noise(double moment, double acceleration) const;

 private:
  World plain_;
  Session bare_;  // fit takes, free of noise
  signals::Dataset records_;
  std::vector<std::complex<double>> gains_;  // moment per base acceleration
  std::vector<double> lengths_;              // samples of the line's take
};

}  // namespace vibrissa::trial
