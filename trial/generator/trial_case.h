#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "trial/classes/case_class.h"
#include "trial/generator/session.h"

namespace vibrissa::trial {

/// Method that computes the sensor's motion.
enum class Physics {
  modes,         // modal_motion.h
  finite_strain  // solid_motion.h
};

struct CaseEffect {
  std::string id;
  double size = 0.;   // signed, in the unit of Unknown::unit
  double limit = 0.;  // detection limit, positive
};

/// One sensor to be diagnosed, with its true causes.
struct TrialCase {
  CaseClass kind = CaseClass::none;
  Physics physics = Physics::modes;
  std::vector<CaseEffect> effects;
  std::vector<std::string> left_out;  // effects that are removed from the catalogue; public
  std::uint64_t seed = 0;
  World world;
  Session session;
};

/// A sensor as simulated on a bench with random noise levels.
World plain_world(std::mt19937_64& random);

/// The case with this number in the trial of a seed. Its class and the removed effect follow a
/// fixed cycle; everything else is random. Sizes are log-uniform from 1 to 30 detection limits,
/// within the usual range. Finite-strain cases contain only effects that the solid can simulate;
/// their detection limits are those of the modes. Proven by
/// tests/trial/generator/detection_limit_test.cc.
TrialCase draw_case(std::uint64_t seed, std::size_t number, Physics physics = Physics::modes);

/// The records of a case, with the metadata of the bench's log, which may be wrong.
signals::Dataset records_of(const TrialCase& trial_case);

/// Records of the further experiments; empty for finite strain, where they would take an hour.
std::vector<FurtherExperiment> further_experiments(Physics physics);
/// Records of the further experiments on another day, by name.
std::vector<std::pair<std::string, signals::Dataset>> further_records_of(
    const TrialCase& trial_case);

/// The simulation of the sensor as designed: the same takes except the one at rest, without noise.
signals::Dataset simulated_records(std::uint64_t seed, Physics physics = Physics::modes);

}  // namespace vibrissa::trial
