#pragma once

#include "trial/plant/motion.h"
#include "trial/plant/state_space.h"
#include "trial/plant/structure.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Course of a simulation's input between its samples.
enum class Hold { band_limited, linear, zero_order };

/// "band_limited", "linear" or "zero_order".
const char* to_string(Hold hold);

/// The linear sensor as a program simulates it that knows its input only at the samples of the
/// records: exact steps for an input that is linear or constant between them. The effects of a
/// world that act on the motion are left out. Proven by tests/trial/plant/held_motion_test.cc.
class HeldMotion : public Motion {
 public:
  /// hold: linear or zero_order.
  HeldMotion(const Structure& structure, const World& world, Hold hold);

  std::size_t steps_per_sample() const override { return 1; }
  std::vector<double> base_moment(const std::vector<double>& acceleration,
                                  const std::vector<double>& wind, std::uint64_t seed) override;

 private:
  double drag_;
  StateSpace plant_;
  FirstOrderHold step_;
  bool is_constant_;
};

}  // namespace vibrissa::trial
