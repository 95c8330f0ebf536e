#pragma once

#include <optional>
#include <vector>

#include "trial/generator/unexplained_change.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {

/// The likelihood-ratio test that knows the form of what a world adds to the plain one: its
/// unexplained change over the noise of both channels, in the fit takes. Noise is taken as white.
class LikelihoodRatio {
 public:
  LikelihoodRatio(const World& plain, const Session& session);

  const World& plain() const { return change_.plain(); }
  double noncentrality(const World& world, bool random) const;

 private:
  UnexplainedChange change_;
  std::vector<double> noise_;
};

/// Non-centrality of one parameter that is found in half of all cases at one false alarm in a
/// hundred.
inline constexpr double half_power_at_one_percent = 6.63;

/// Size at which that test finds an unknown in half of all cases at one false alarm in a hundred
/// (non-centrality 6.63 for one parameter), and that benches' own spread does not hide. Nothing
/// where even the largest stays below. Proven by tests/trial/generator/detection_limit_test.cc.
std::optional<double> detection_limit(const LikelihoodRatio& test, const Unknown& unknown,
                                      double sign, double shape);

}  // namespace vibrissa::trial
