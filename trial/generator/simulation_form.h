#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "trial/plant/held_motion.h"
#include "trial/plant/structure.h"

namespace vibrissa::trial {

/// A simulation whose modes and hold are not those of the sensor.
struct SimulationForm {
  Structure structure;
  Hold hold = Hold::band_limited;
};

/// Rms difference of two structures' transfer function from base acceleration to moment over the
/// band of the session (3 to 110 Hz), relative to the rms of the first: the relative error of the
/// moment under a flat base excitation.
double form_error(const Structure& sensor, const Structure& simulation);

/// A form with that error: fewer modes, with or without their static correction; then the
/// participation of all modes and the damping of the higher modes are off in random directions, by
/// the amount that makes up the error. The hold is drawn, too; it does not count into the error,
/// because it acts between the samples and not on the sensor. 0: the structure itself,
/// band-limited. Proven by tests/trial/generator/simulation_form_test.cc.
SimulationForm draw_form(const Structure& sensor, double error, std::uint64_t seed);

nlohmann::json to_json(const SimulationForm& form);

}  // namespace vibrissa::trial
