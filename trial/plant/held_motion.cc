#include "trial/plant/held_motion.h"

#include <cassert>
#include <cmath>

#include "trial/plant/plant.h"

namespace vibrissa::trial {

const char* to_string(const Hold hold) {
  return hold == Hold::linear ? "linear" : hold == Hold::zero_order ? "zero_order" : "band_limited";
}

HeldMotion::HeldMotion(const Structure& structure, const World& world, const Hold hold)
    : drag_(world.drag),
      plant_(make_plant(structure, world)),
      step_(plant_, 1. / rate_hz),
      is_constant_(hold == Hold::zero_order) {
  assert(hold != Hold::band_limited && "needs a finer grid: ModalMotion");
}

std::vector<double> HeldMotion::base_moment(const std::vector<double>& acceleration,
                                            const std::vector<double>& wind, std::uint64_t) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(plant_.a.rows()), f = Eigen::VectorXd::Zero(input::n);
  std::vector<double> out(acceleration.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Eigen::VectorXd next = f;
    next(input::acceleration) = acceleration[i];
    next(input::wind) = drag_ * wind[i] * std::abs(wind[i]);
    x = step_.transition * x + step_.now * f + step_.next * (is_constant_ ? f : next);
    f = next;
    out[i] = plant_.c.row(output::moment).dot(x) + plant_.d.row(output::moment).dot(f);
  }
  return out;
}

}  // namespace vibrissa::trial
