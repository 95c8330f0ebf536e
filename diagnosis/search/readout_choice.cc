#include "diagnosis/search/readout_choice.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

/// Log odds from which on another readout is believed [nats].
constexpr double believed_nats = 7.;

bool has_joint_law(const Hypothesis& hypothesis) {
  return std::ranges::any_of(hypothesis.effects(),
                             [](const Effect* effect) { return !probe(*effect).joint.empty(); });
}

}  // namespace

SimulationAndRecords read_as_rotation(SimulationAndRecords given) {
  NominalModel& nominal = given.simulation.nominal;
  if (!nominal.readout_is_given) nominal.readout = signals::Readout::rotation;
  nominal.readout_is_given = true;
  for (signals::DatasetRecord& entry : given.real.records) {
    entry.readout = signals::Readout::rotation;
    entry.readout_is_given = true;
  }
  given.real.guesses.emplace_back(
      "the moment channel is read as a rotation: a spring that is not linear fits it better so; "
      "\"readout\" in dataset.json says what it is");
  return given;
}

bool is_rotation(const SimulationAndRecords& given, const Experiment& experiment,
                 const SearchResult& result) {
  constexpr std::ptrdiff_t n_probable = 3;
  if (!given.real.responses.empty() ||
      std::ranges::any_of(given.real.records, &signals::DatasetRecord::readout_is_given))
    return false;
  const auto nonlinear = std::ranges::find_if(result.candidates, [&](const Candidate& candidate) {
    return has_joint_law(result.fits[candidate.fit].hypothesis);
  });
  if (nonlinear - result.candidates.begin() >= std::min(n_probable, std::ssize(result.candidates)))
    return false;
  // One effect or none that leaves nothing is simpler than another readout.
  const HypothesisFit& best = result.fits[result.candidates.front().fit];
  if (best.hypothesis.effects().size() <= 1 &&
      largest_error_left(experiment, best) < std::pow(experiment.simulation_accuracy, 2))
    return false;
  const SimulationAndRecords other = read_as_rotation(given);
  Experiment reread =
      prepare_experiment(other.simulation, other.real, signals::Split::fit, InputNoise::reduced);
  reread.simulation_accuracy = experiment.simulation_accuracy;
  reread.measured_modes = experiment.measured_modes;
  const HypothesisFit& as_moment = result.fits[nonlinear->fit];
  const double prior = nonlinear->log_posterior - as_moment.log_evidence;
  const double to_beat = result.candidates.front().log_posterior + believed_nats - prior;
  return fit_hypothesis(reread, as_moment.hypothesis, nullptr, {.to_beat = to_beat}).log_evidence >
         to_beat;
}

}  // namespace vibrissa::diagnosis
