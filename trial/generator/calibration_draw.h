#pragma once

#include <map>
#include <random>
#include <string>

#include "trial/classes/circumstances.h"
#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Relative deviations of sensors from their simulation as drawn for Distance::as_paper.
struct PaperDistance {
  double low = 0., high = 0.;
  bool either_sign = false;
};
inline constexpr PaperDistance paper_modulus{0.1, 0.45}, paper_damping{0.15, 0.55},
    paper_gain{0.05, 0.2, true}, paper_drag{0.1, 0.35, true};

/// Draws modulus, damping, gains and drag of a sensor at that distance from its simulation.
/// as_built: normal, cut at two standard deviations (built_modulus ... of world.h; the
/// accelerometer is as simulated). as_paper: uniform in the ranges above; modulus and damping are
/// lower than simulated. Proven by tests/trial/generator/calibration_draw_test.cc.
void draw_calibrations(World& world, Distance distance, std::mt19937_64& random);

/// Ratio of the sensor to its simulation by the effect's id: stiffness (modulus), damping,
/// sensor_gain, reference_gain, drag_error.
std::map<std::string, double> calibrations_of(const World& world);

/// Standard deviation of each of these ratios, about its mean at a distance, that whoever judges a
/// sensor must allow for: nobody knows that a sensor is exactly as designed, so exact has the
/// building tolerances, too.
std::map<std::string, double> calibration_deviations(Distance distance);

}  // namespace vibrissa::trial
