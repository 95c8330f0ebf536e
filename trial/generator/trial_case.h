#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "trial/classes/case_class.h"
#include "trial/classes/circumstances.h"
#include "trial/generator/session.h"
#include "trial/generator/simulation_form.h"

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
  double shape = 0.;  // Unknown::apply
};

/// One sensor to be diagnosed, with its true causes.
struct TrialCase {
  CaseClass kind = CaseClass::none;
  Physics physics = Physics::modes;
  Circumstances circumstances;
  double accuracy =
      stated_accuracy(FormError::zero);  // of the simulation, for the detection limits
  std::vector<CaseEffect> effects;
  std::vector<std::string> left_out;  // effects that are removed from the catalogue; public
  std::uint64_t seed = 0;
  World plain;  // without the effects, at its distance
  World world;
  Session session;
};

/// A sensor as simulated on a bench with random noise levels.
World plain_world(std::mt19937_64& random);

/// Class of the case with this number: a fixed cycle of twenty.
CaseClass class_of(std::size_t number);

/// The case with this number in the trial of a seed. Its class and the removed effect follow a
/// fixed cycle; everything else is random. Sizes are log-uniform from 1 to 30 detection limits in
/// the records of its set, at its distance and for a simulation of this accuracy, within
/// the usual range. Finite-strain cases contain only effects that
/// the solid can simulate; their detection limits are those of the modes. On a sensor at a distance
/// no effect is drawn that calibrations can imitate. Proven by
/// tests/trial/generator/detection_limit_test.cc and record_set_test.cc.
TrialCase draw_case(std::uint64_t seed, std::size_t number, Physics physics = Physics::modes,
                    const Circumstances& circumstances = {},
                    double accuracy = stated_accuracy(FormError::zero));

/// The records of a case, with the metadata of the bench's log, which may be wrong.
signals::Dataset records_of(const TrialCase& trial_case);

/// The further experiments of a case; none for finite strain, where they would take an hour.
std::vector<FurtherExperiment> further_experiments_of(const TrialCase& trial_case);
/// Records of the further experiments on another day, by name.
std::vector<std::pair<std::string, signals::Dataset>> further_records_of(
    const TrialCase& trial_case);

/// The simulation of the sensor as designed: the same takes except the one at rest, without noise.
signals::Dataset simulated_records(std::uint64_t seed, Physics physics = Physics::modes);
/// The same from a simulation of another form, with the takes of a set.
signals::Dataset simulated_records(std::uint64_t seed, const SimulationForm& form, RecordSet set);

/// Does a case have a simulation of its own, other than the common simulated_records(seed)?
bool has_own_simulation(const Circumstances& circumstances);
/// The form of its simulation.
SimulationForm form_of(const TrialCase& trial_case);

}  // namespace vibrissa::trial
