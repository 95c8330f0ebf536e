#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "benchmarks/trial/session.h"
#include "benchmarks/trial/unknowns.h"

namespace vibrissa::trial {

/// Solved structures are kept: few worlds differ in their solid.
const Structure& structure_of(const SolidChange& change);

/// The likelihood-ratio test that knows the form of what a world adds to the plain one: change of
/// the moment that the measured base motion does not foretell, over the noise of both channels, in
/// the fit takes. Noise is taken as white. The plain sensor is measured once.
class LikelihoodRatio {
 public:
  LikelihoodRatio(const World& plain, const Session& session);

  const World& plain() const { return plain_; }
  double noncentrality(const World& world, bool random) const;

 private:
  struct Line {
    std::complex<double> gain;  // moment per base acceleration
    double noise;               // of both channels [(N m)^2 of an unscaled DFT]
  };

  World plain_;
  Session bare_;  // fit takes, free of noise
  signals::Dataset records_;
  std::vector<std::vector<Line>> lines_;  // [record][bin]
};

/// Size at which that test finds an unknown in half of all cases at one false alarm in a hundred
/// (non-centrality 6.63 for one parameter), and that benches' own spread does not hide. Nothing
/// where even the largest stays below. Proven by tests/benchmarks/trial/detection_limit_test.cc.
std::optional<double> detection_limit(const LikelihoodRatio& test, const Unknown& unknown,
                                      double sign, double shape);

}  // namespace vibrissa::trial
