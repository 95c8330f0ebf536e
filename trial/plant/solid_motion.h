#pragma once

#include <memory>

#include "trial/plant/motion.h"
#include "trial/plant/world.h"

namespace vibrissa::fem {
class Sensor;
}

namespace vibrissa::trial {

/// Can the solid simulate all deviations of a world? It has no hinge law, mount, further mode or
/// relative wind; its silicone relaxes.
bool is_of_the_solid(const World& world);

/// The whole solid at finite strain, the wind's pressure on its deformed surface
/// (fem/motion/nonlinear_transient.h), at 8 times the sampling rate; at rest before each record.
/// The relaxation branches act on the silicone's stress. Proven by
/// tests/trial/plant/solid_motion_test.cc.
class SolidMotion : public Motion {
 public:
  /// Meshes, assembles and solves. Throws UserError when !is_of_the_solid(world).
  explicit SolidMotion(const World& world);
  ~SolidMotion() override;

  std::size_t steps_per_sample() const override { return 8; }
  /// About 5 ms per step.
  std::vector<double> base_moment(const std::vector<double>& acceleration,
                                  const std::vector<double>& wind, std::uint64_t seed) override;

 private:
  double shedding_;
  std::unique_ptr<fem::Sensor> sensor_;
};

}  // namespace vibrissa::trial
