#pragma once

#include <optional>
#include <vector>

#include "trial/generator/signature.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {

/// Likelihood-ratio test that knows the form of a world's change relative to the plain world: its
/// unexplained change relative to the noise of both channels, in the fit takes. The noise is
/// assumed white. The test allows for the calibrations of a distance, building tolerances at least,
/// and for a simulation of that accuracy (unknown_changes()): otherwise it would raise an alarm on
/// every sensor. Calibrations count in proportion alone: with little noise the test still sees that
/// the shift of a resonance is not proportional to the stiffness, so limits of stiffness and mass
/// stay below the building tolerance.
class LikelihoodRatio {
 public:
  LikelihoodRatio(const World& plain, const Session& session, Distance distance = Distance::exact,
                  double accuracy = 0.);

  const World& plain() const { return change_.plain(); }
  double noncentrality(const World& world, bool random) const;

 private:
  UnexplainedChange change_;
  std::vector<double> noise_;
  WidenedNoise widened_;
};

/// Non-centrality at which one parameter is detected in half of all cases with 1 % false alarms.
inline constexpr double half_power_at_one_percent = 6.63;

/// Detection limit: the size at which that test detects an effect in half of all cases with 1 %
/// false alarms (non-centrality 6.63 for one parameter), but at least the variation between
/// benches. Nothing when even the largest size stays below it. Proven by
/// tests/trial/generator/detection_limit_test.cc.
std::optional<double> detection_limit(const LikelihoodRatio& test, const Unknown& unknown,
                                      double sign, double shape);

}  // namespace vibrissa::trial
