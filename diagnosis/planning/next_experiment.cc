#include "diagnosis/planning/next_experiment.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/localisation/location.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// An answer that may be true and its weight.
struct Answer {
  std::string name;
  double weight = 0.;
};

/// What an entry shows for an answer: of each of its effects, in order.
std::string sign(const MenuEntry& entry, const std::string& name) {
  std::set<std::string> signs;
  for (const std::string& id : effect_ids(name))
    if (const auto found = entry.shows.find(id); found != entry.shows.end())
      signs.insert(found->second);
  std::string text;
  for (const std::string& one : signs) text += one + ";";
  return text;
}

std::vector<Answer> answers_left(const std::vector<Candidate>& candidates,
                                 const std::vector<std::string>& confidence_set,
                                 const std::vector<std::vector<std::string>>& indistinguishable) {
  // What the data cannot split gets this odds beside the named one: priors alone have chosen.
  constexpr double unsplit_odds = 0.3;
  std::vector<Answer> answers;
  double best = 0.;
  const auto add = [&](const std::string& name, double weight) {
    for (const Answer& answer : answers)
      if (answer.name == name) return;
    answers.push_back({name, weight});
  };
  for (const Candidate& candidate : candidates) {
    best = std::max(best, candidate.probability);
    if (std::find(confidence_set.begin(), confidence_set.end(), candidate.name) !=
        confidence_set.end())
      add(candidate.name, candidate.probability);
  }
  for (const std::vector<std::string>& set : indistinguishable)
    for (const std::string& id : set) add(id, unsplit_odds * best);
  return answers;
}

/// Probability that two answers, drawn by weight, are shown differently.
double split(const MenuEntry& entry, const std::vector<Answer>& answers) {
  std::map<std::string, double> classes;
  double total = 0.;
  for (const Answer& answer : answers) {
    classes[sign(entry, answer.name)] += answer.weight;
    total += answer.weight;
  }
  double same = 0.;
  for (const auto& [shown, weight] : classes) same += weight * weight / (total * total);
  return 1. - same;
}

/// Weight of the answers that an entry shows in a way of its own: an effect that is merely absent
/// proves less.
double shown_share(const MenuEntry& entry, const std::vector<Answer>& answers) {
  double shown = 0., total = 0.;
  for (const Answer& answer : answers) {
    if (!sign(entry, answer.name).empty()) shown += answer.weight;
    total += answer.weight;
  }
  return shown / total;
}

std::string what_it_shows(const MenuEntry& entry, const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids)
    if (const auto found = entry.shows.find(id); found != entry.shows.end())
      text += (text.empty() ? "" : "; ") + id + ": " + found->second;
  return text;
}

}  // namespace

const std::vector<MenuEntry>& experiment_menu() {
  static const std::vector<MenuEntry> menu{
      {"level_ladder",
       "the same lines at four levels, up and down again",
       {{"hardening", "resonance moves with level squared"},
        {"softening_history", "the way down differs from the way up"},
        {"joint_friction", "damping rises, then falls with level"},
        {"backlash", "worst at the lowest level"},
        {"sensor_nonlinearity", "harmonics grow, resonance stays"},
        {"viscoelastic", "nothing changes with level"},
        {"damping", "nothing changes with level"},
        {"stiffness", "nothing changes with level"},
        {"reference_noise", "relative error falls with level"},
        {"hum", "relative error falls with level"}}},
      {"wind_ladder",
       "wind at four speeds, with and without base motion",
       {{"relative_drag", "damping grows with wind speed"},
        {"damping", "damping does not depend on wind"},
        {"vortex_shedding", "its line moves with wind speed"},
        {"hum", "its line stays"},
        {"drag_error", "error in proportion to wind squared"},
        {"flow_lag", "error falls where wind is steady"},
        {"turbulence", "broad band that grows with wind squared"},
        {"sensor_drift", "does not depend on wind"}}},
      {"steady_wind",
       "steady wind for a minute, base at rest",
       {{"turbulence", "broad band remains"},
        {"drag_error", "static moment is off"},
        {"sensor_gain", "static moment is off"},
        {"flow_lag", "no error in steady wind"},
        {"vortex_shedding", "one line"},
        {"sensor_drift", "slow wander"}}},
      {"wide_band",
       "base motion from 1 Hz to 0.45 of the sampling rate",
       {{"delay", "phase in proportion to frequency, magnitude intact"},
        {"sensor_lowpass", "magnitude falls at high frequency"},
        {"reference_gain", "same factor at every frequency"},
        {"sensor_gain", "same factor at every frequency"},
        {"reference_highpass", "error at the lowest lines"},
        {"stage_rocking", "gain grows towards the rocking resonance"},
        {"mount_compliance", "gain grows and the first mode is loaded"},
        {"extra_mode", "one more peak or dip"},
        {"coil_feedthrough", "added real term, antiresonance moves"},
        {"viscoelastic", "stiffness and loss drift over octaves"},
        {"stiffness", "only the pole moves"},
        {"base_compliance", "second mode moves differently"},
        {"damping", "loss of each mode alike"},
        {"mass", "quasi-static gain moves with the pole"}}},
      {"added_mass",
       "0.1 g at the tip",
       {{"stiffness", "pole moves by the softer spring's share"},
        {"mass", "pole moves less than nominal"},
        {"base_compliance", "pole moves more than by stiffness"},
        {"reference_gain", "ratio of responses intact"},
        {"sensor_gain", "known added moment is off"}}},
      {"tilt",
       "the sensor tilted by 90 and 180 degrees",
       {{"mass", "static moment of gravity is off"},
        {"sensor_gain", "static moment is off, accelerometer reads 1 g"},
        {"reference_gain", "accelerometer does not read 1 g"},
        {"coil_feedthrough", "static moment intact"},
        {"drag_error", "static moment intact, accelerometer reads 1 g"},
        {"stiffness", "static moment intact"}}},
      {"clamped_stage",
       "the stage clamped, the coil driven",
       {{"coil_feedthrough", "reading without motion"},
        {"mass", "no reading"},
        {"hum", "line without motion"},
        {"stage_rocking", "no reading"}}},
      {"magnet_removed",
       "the sensor's magnet taken off",
       {{"coil_feedthrough", "reading remains"},
        {"hum", "line remains"},
        {"sensor_drift", "drift remains"},
        {"vortex_shedding", "line is gone"},
        {"temperature_drift", "nothing remains"}}},
      {"other_sampling_rate",
       "the same excitation at another sampling rate",
       {{"sample_repeat", "repeats change with the ratio of rates"},
        {"delay", "same delay in seconds"},
        {"sensor_lowpass", "corner moves with the conversion time"},
        {"clock_drift", "drift changes with the clocks"},
        {"hum", "line stays in hertz"},
        {"vortex_shedding", "an aliased line moves"}}},
      {"quiet_record",
       "a minute with everything at rest",
       {{"sensor_drift", "slow wander at rest"},
        {"hum", "line at rest"},
        {"turbulence", "nothing at rest"},
        {"vortex_shedding", "nothing at rest"},
        {"reference_noise", "accelerometer noisy at rest"},
        {"cross_axis", "nothing at rest"}}},
      {"rotate_sensor",
       "the sensor turned by 90 degrees about its axis",
       {{"cross_axis", "error follows the transverse axis"},
        {"extra_mode", "peak changes its height"},
        {"stage_rocking", "error stays with the stage"},
        {"mount_compliance", "error stays with the stage"},
        {"reference_noise", "unchanged"}}}};
  return menu;
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
    if (!possible.empty() &&
        std::find(possible.begin(), possible.end(), entry.name) == possible.end())
      continue;
    const double value = split(entry, answers);
    const double worth = value * (0.5 + 0.5 * shown_share(entry, answers));
    if (worth <= best_worth + 1e-9) continue;
    best_worth = worth;
    out.split_probability = value;
    best = &entry;
  }
  if (best == nullptr) {
    out.why = answers.size() < 2 ? "the answer is clear" : "no experiment of the menu splits these";
    return out;
  }
  std::set<std::string> ids;
  for (const Answer& answer : answers)
    for (const std::string& id : effect_ids(answer.name))
      if (best->shows.count(id) != 0) ids.insert(id);
  out.name = best->name;
  out.would_separate.assign(ids.begin(), ids.end());
  out.why = best->what + " (" + what_it_shows(*best, out.would_separate) + ")";
  return out;
}

void check_menu_names(const std::vector<std::string>& names) {
  std::string known;
  for (const MenuEntry& entry : experiment_menu())
    known += (known.empty() ? "" : ", ") + entry.name;
  for (const std::string& name : names)
    if (std::none_of(experiment_menu().begin(), experiment_menu().end(),
                     [&](const MenuEntry& entry) { return entry.name == name; }))
      throw signals::UserError("unknown experiment '" + name + "'; known are " + known);
}

}  // namespace vibrissa::diagnosis
