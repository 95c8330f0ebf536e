#pragma once

#include <span>
#include <vector>

#include "separation/ringdown/decay_fit.h"

namespace vibrissa::separation {

/// Moments of free decays [N m].
using DecayMoments = std::vector<std::span<const double>>;

/// Schwarz's criterion (BIC, 1978): smaller is better; infinite where the decays do not determine
/// the parameters.
double criterion(const FittedDecay& fit);

/// A law that has grown, and the others that were tried on the same pieces and whose parameters are
/// told: other parts, and the other form of friction.
struct GrownLaw {
  FittedDecay fit;
  std::vector<FittedDecay> others;
};

/// Fit of a law that grows from a viscous one: the part (cubic spring, drag, friction) that lowers
/// the criterion most is added as long as it lowers it by 10 (Kass and Raftery 1995, section 3.2);
/// at last a part leaves where the law without it is not worse by 10: a later one explains the
/// same. The first periods of pieces are left out while their errors are larger than those behind
/// them: other modes still ring. pieces: those that were fitted. Throws UserError where a linear
/// mode of that frequency cannot be fitted at this rate, and where no mode explains half of the
/// moment. Proven by tests/separation/ringdown/ring_down_test.cc.
GrownLaw grow_law(double frequency_hz, double sampling_rate_hz, DecayMoments& pieces);

}  // namespace vibrissa::separation
