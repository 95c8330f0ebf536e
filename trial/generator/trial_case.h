#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "trial/generator/session.h"

namespace vibrissa::trial {

/// What kind of question a case asks.
enum class CaseClass {
  single,
  pair,
  triple,
  none,
  calibration_only,  // a little off in modulus, damping, gains and drag, as every built sensor
  nameless,          // something that no catalogue has
  left_out,          // one effect that the diagnoser's catalogue is told to lack
  below_limit,       // a quarter of the detection limit
  wrong_metadata     // a take that says wind was on, or another period
};
std::string to_string(CaseClass kind);

/// What the sensor's motion is computed by.
enum class Physics {
  modes,         // modal_motion.h
  finite_strain  // solid_motion.h
};

struct CaseEffect {
  std::string id;
  double size = 0.;   // signed, in the unit of unknowns.h
  double limit = 0.;  // detection limit, positive
};

/// One sensor to be diagnosed, with the truth about it.
struct TrialCase {
  CaseClass kind = CaseClass::none;
  Physics physics = Physics::modes;
  std::vector<CaseEffect> effects;
  std::vector<std::string> left_out;  // of the catalogue; public
  std::uint64_t seed = 0;
  World world;
  Session session;
};

/// A sensor as simulated on a bench of its own: how noisy its channels are is by chance.
World plain_world(std::mt19937_64& random);

/// Case number of a trial's seed: its class by turns, what is left out of the catalogue, too, all
/// else by chance. Sizes are log-uniform from 1 to 30 detection limits, within the usual range.
/// Of finite strain only what the solid can do is asked, in detection limits of the modes. Proven
/// by tests/trial/generator/detection_limit_test.cc.
TrialCase draw_case(std::uint64_t seed, std::size_t number, Physics physics = Physics::modes);

/// The records of a case, its takes labelled as the bench's log says, which may be wrong.
signals::Dataset records_of(const TrialCase& trial_case);

/// What the bench can do besides. Nothing of finite strain, where it would take an hour.
std::vector<FurtherExperiment> further_experiments(Physics physics);
/// What further experiments would show of it, on another day: their records by name.
std::vector<std::pair<std::string, signals::Dataset>> further_records_of(
    const TrialCase& trial_case);

/// The simulation of the sensor as designed: the same takes without one at rest, free of noise.
signals::Dataset simulated_records(std::uint64_t seed, Physics physics = Physics::modes);

}  // namespace vibrissa::trial
