#pragma once

#include "trial/plant/state_space.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Indices of the inputs and outputs of the mechanical plant.
namespace input {
enum : Eigen::Index { acceleration, tilt_acceleration, wind, hinge, n };
}
namespace output {
enum : Eigen::Index { moment, hinge_turn, hinge_rate, wind_velocity, n };
}

/// The linear system from stage and wind to the moment: the modes, a spring under the base, a base
/// that moves on its mount, an additional oscillator. Inputs: axial [m/s^2] and rotational
/// [rad/s^2] acceleration of the stage, wind u|u| [m^2/s^2], moment of the hinge in addition to its
/// spring [N m]. Outputs: base moment on the support [N m], rotation [rad] and rate of the hinge,
/// mean velocity of the surface in the wind [m/s]. Proven by tests/trial/plant/structure_test.cc.
StateSpace make_plant(const Structure& structure, const World& world);

}  // namespace vibrissa::trial
