#include "diagnosis/planning/next_experiment.h"

#include <algorithm>
#include <set>

#include "diagnosis/model/json.h"
#include "diagnosis/model/words.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// A possible answer and its weight.
struct Answer {
  std::string name;
  double weight = 0.;
};

/// What an entry shows for an answer: one text for each of its effects, in order.
std::string sign(const MenuEntry& entry, const std::string& name) {
  std::set<std::string> signs;
  for (const std::string& id : effect_ids(name))
    if (entry.shows.contains(id)) signs.insert(entry.shows.at(id));
  return joined({signs.begin(), signs.end()}, ";");
}

std::vector<Answer> answers_left(const std::vector<Candidate>& candidates,
                                 const std::vector<std::string>& confidence_set,
                                 const std::vector<std::vector<std::string>>& indistinguishable) {
  // An effect that the data cannot distinguish from the named one gets these odds, because only
  // priors decided.
  constexpr double unsplit_odds = 0.3;
  std::vector<Answer> answers;
  double best = 0.;
  const auto add = [&](const std::string& name, double weight) {
    if (std::ranges::find(answers, name, &Answer::name) == answers.end())
      answers.push_back({name, weight});
  };
  for (const Candidate& candidate : candidates) {
    best = std::max(best, candidate.probability);
    if (std::ranges::count(confidence_set, candidate.name) > 0)
      add(candidate.name, candidate.probability);
  }
  for (const std::vector<std::string>& set : indistinguishable)
    for (const std::string& id : set) add(id, unsplit_odds * best);
  return answers;
}

/// Probability that two answers, drawn by weight, give different observations; and the share of the
/// answers for which the entry has an observation of its own, as the mere absence of an effect
/// proves less.
struct Split {
  double probability = 0., shown = 0.;
};

Split split(const MenuEntry& entry, const std::vector<Answer>& answers) {
  std::map<std::string, double> classes;
  double total = 0., same = 0.;
  for (const Answer& answer : answers) {
    classes[sign(entry, answer.name)] += answer.weight;
    total += answer.weight;
  }
  for (const auto& [shown, weight] : classes) same += weight * weight / (total * total);
  return {1. - same, 1. - classes[""] / total};
}

/// What the first few effects would show.
std::string what_it_shows(const MenuEntry& entry, const std::vector<std::string>& ids) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, ids.size()); ++i)
    text += (i == 0 ? "if the cause is " : "; if it is ") + ids[i] +
            ", expect: " + entry.shows.at(ids[i]);
  return text;
}

}  // namespace

const std::vector<MenuEntry>& experiment_menu() {
  static const std::vector<MenuEntry> menu{
      {"level_ladder",
       "the same lines at four levels, up and down again",
       {{"hardening", "resonance shifts with level squared"},
        {"softening_history", "the way down differs from the way up"},
        {"joint_friction", "damping rises, then falls with level"},
        {"backlash", "largest relative error at the lowest level"},
        {"sensor_nonlinearity", "harmonics grow, resonance unchanged"},
        {"viscoelastic", "nothing changes with level"},
        {"damping", "nothing changes with level"},
        {"stiffness", "nothing changes with level"},
        {"reference_noise", "relative error falls with level"},
        {"hum", "relative error falls with level"}}},
      {"wind_ladder",
       "wind at four speeds, with and without base motion",
       {{"relative_drag", "damping grows with wind speed"},
        {"damping", "damping does not depend on wind"},
        {"vortex_shedding", "its spectral line moves with wind speed"},
        {"hum", "its spectral line does not move"},
        {"drag_error", "error proportional to wind squared"},
        {"flow_lag", "error falls where wind is steady"},
        {"turbulence", "broadband noise grows with wind squared"},
        {"sensor_drift", "does not depend on wind"}}},
      {"steady_wind",
       "steady wind for a minute, base at rest",
       {{"turbulence", "broadband noise remains"},
        {"drag_error", "static moment differs"},
        {"sensor_gain", "static moment differs"},
        {"flow_lag", "no error in steady wind"},
        {"vortex_shedding", "one spectral line"},
        {"sensor_drift", "slow drift"}}},
      {"wide_band",
       "multisine or noise at the base from 1 Hz to 0.45 times the sampling rate",
       {{"delay", "phase proportional to frequency, magnitude unchanged"},
        {"sensor_lowpass", "magnitude falls at high frequency"},
        {"reference_gain", "same factor at every frequency"},
        {"sensor_gain", "same factor at every frequency"},
        {"reference_highpass", "error at the lowest lines"},
        {"stage_rocking", "gain grows towards the rocking resonance"},
        {"mount_compliance", "gain grows and the first mode shifts"},
        {"extra_mode", "one more peak or dip"},
        {"coil_feedthrough", "added real term, antiresonance shifts"},
        {"viscoelastic", "stiffness and loss change over several octaves"},
        {"stiffness", "only the pole shifts"},
        {"base_compliance", "second mode shifts differently"},
        {"damping", "same damping change in each mode"},
        {"mass", "quasi-static gain changes with the pole"}}},
      {"added_mass",
       "0.1 g at the tip",
       {{"stiffness", "pole shifts as for the softer spring"},
        {"mass", "pole shifts less than simulated"},
        {"base_compliance", "pole shifts more than for stiffness"},
        {"reference_gain", "ratio of the responses unchanged"},
        {"sensor_gain", "moment of the added mass differs"}}},
      {"tilt",
       "the sensor tilted by 90 and 180 degrees",
       {{"mass", "static moment of gravity differs"},
        {"sensor_gain", "static moment differs, accelerometer reads 1 g"},
        {"reference_gain", "accelerometer does not read 1 g"},
        {"coil_feedthrough", "static moment correct"},
        {"drag_error", "static moment correct, accelerometer reads 1 g"},
        {"stiffness", "static moment correct"}}},
      {"clamped_stage",
       "the shaker's table clamped, its coil driven",
       {{"coil_feedthrough", "reading without motion"},
        {"mass", "no reading"},
        {"hum", "spectral line without motion"},
        {"stage_rocking", "no reading"}}},
      {"magnet_removed",
       "the sensor's magnet taken off",
       {{"coil_feedthrough", "reading remains"},
        {"hum", "spectral line remains"},
        {"sensor_drift", "drift remains"},
        {"vortex_shedding", "spectral line disappears"},
        {"temperature_drift", "no reading remains"}}},
      {"other_sampling_rate",
       "the same excitation at another sampling rate",
       {{"sample_repeat", "repeats change with the ratio of rates"},
        {"delay", "same delay in seconds"},
        {"sensor_lowpass", "corner frequency changes with the conversion time"},
        {"clock_drift", "drift changes with the clocks"},
        {"hum", "spectral line at the same frequency"},
        {"vortex_shedding", "aliased spectral line moves"}}},
      {"quiet_record",
       "a minute with everything at rest",
       {{"sensor_drift", "slow drift at rest"},
        {"hum", "spectral line at rest"},
        {"turbulence", "nothing at rest"},
        {"vortex_shedding", "nothing at rest"},
        {"reference_noise", "accelerometer noisy at rest"},
        {"cross_axis", "nothing at rest"}}},
      {"rotate_sensor",
       "the sensor turned by 90 degrees about its axis",
       {{"cross_axis", "error follows the transverse axis"},
        {"extra_mode", "height of the peak changes"},
        {"stage_rocking", "error unchanged, as the stage is not turned"},
        {"mount_compliance", "error unchanged, as the stage is not turned"},
        {"reference_noise", "unchanged"}}}};
  return menu;
}

void to_json(Json& out, const NextExperiment& next) {
  out = {{"name", next.name},
         {"why", next.why},
         {"would_separate", next.would_separate},
         {"split_probability", next.split_probability}};
}

NextExperiment next_experiment(const std::vector<Candidate>& candidates,
                               const std::vector<std::string>& confidence_set,
                               const std::vector<std::vector<std::string>>& indistinguishable,
                               const std::vector<std::string>& possible) {
  const std::vector<Answer> answers = answers_left(candidates, confidence_set, indistinguishable);
  NextExperiment out;
  const MenuEntry* best = nullptr;
  double best_worth = 0.;
  for (const MenuEntry& entry : experiment_menu()) {
    if (!possible.empty() && std::ranges::count(possible, entry.name) == 0) continue;
    const auto [probability, shown] = split(entry, answers);
    const double worth = probability * (0.5 + 0.5 * shown);
    if (worth <= best_worth + 1e-9) continue;
    best_worth = worth;
    out.split_probability = probability;
    best = &entry;
  }
  if (best == nullptr) {
    out.why = answers.size() < 2
                  ? "nothing: no other known cause is left to be told apart"
                  : "no experiment that vibrissa knows tells the remaining answers apart";
    return out;
  }
  std::map<std::string, double> weights;
  for (const Answer& answer : answers)
    for (const std::string& id : effect_ids(answer.name))
      if (best->shows.count(id) != 0) weights[id] += answer.weight;
  out.name = best->name;
  for (const auto& [id, weight] : weights) out.would_separate.push_back(id);
  std::ranges::stable_sort(out.would_separate, std::ranges::greater(),
                           [&](const std::string& id) { return weights[id]; });
  out.why = best->what + " (" + what_it_shows(*best, out.would_separate) + ")";
  return out;
}

void check_menu_names(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const MenuEntry& entry : experiment_menu()) known.push_back(entry.name);
  for (const std::string& name : names)
    if (std::ranges::count(known, name) == 0)
      throw signals::UserError("unknown experiment '" + name +
                               "'; known experiments: " + joined(known, ", "));
}

}  // namespace vibrissa::diagnosis
