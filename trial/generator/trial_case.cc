#include "trial/generator/trial_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "trial/generator/calibration_draw.h"
#include "trial/generator/circumstance_draw.h"
#include "trial/generator/effect_draw.h"
#include "trial/generator/record_set.h"
#include "trial/plant/solid_motion.h"

namespace vibrissa::trial {
namespace {

using enum CaseClass;
/// Cycle of twenty cases; single effects are the most frequent.
constexpr std::array turns{single,           pair,       none, single,   nameless, single,
                           left_out,         single,     pair, single,   triple,   single,
                           calibration_only, single,     none, left_out, single,   wrong_metadata,
                           nameless,         below_limit};

/// Purposes of random streams of a case.
enum : std::uint32_t { of_calibrations = 101, of_the_form };

/// Effects that others in the catalogue can replace exactly, or that every hypothesis contains as
/// calibration parameters. Removing them from the catalogue does not make the cause an unknown one.
bool has_exact_alias(const std::string& id) {
  static const std::set<std::string> aliased{"stiffness",  "base_compliance", "mass",
                                             "damping",    "reference_gain",  "sensor_gain",
                                             "drag_error", "reference_noise"};
  return aliased.count(id) != 0;
}

bool can_do(const Physics physics, const Unknown& unknown) {
  if (physics == Physics::modes) return true;
  World world;
  unknown.apply(world, unknown.largest, 0.5);
  return is_of_the_solid(world);
}

std::vector<Unknown> those_of(const Physics physics, std::vector<Unknown> list) {
  std::erase_if(list, [&](const Unknown& unknown) { return !can_do(physics, unknown); });
  return list;
}

std::vector<Unknown> those_at(const Distance distance, std::vector<Unknown> list) {
  if (distance != Distance::exact)
    std::erase_if(list, [](const Unknown& unknown) { return is_a_calibration(unknown.id); });
  return list;
}

std::vector<Unknown> without_aliases(std::vector<Unknown> list) {
  std::erase_if(list, [](const Unknown& unknown) { return has_exact_alias(unknown.id); });
  return list;
}

/// Number of cases of a kind before the case with this number.
std::size_t n_before(const CaseClass kind, const std::size_t number) {
  const auto in = [&](std::size_t n) {
    return static_cast<std::size_t>(std::count(turns.begin(), turns.begin() + n, kind));
  };
  return number / turns.size() * in(turns.size()) + in(number % turns.size());
}

void add_effects(TrialCase& out, const std::size_t number, std::mt19937_64& random) {
  const std::vector<Unknown> named =
      those_at(out.circumstances.distance, those_of(out.physics, named_unknowns()));
  EffectDraw draw(out, random);
  const std::size_t n_named = out.kind == triple   ? 3
                              : out.kind == pair   ? 2
                              : out.kind == single ? 1
                                                   : 0;
  for (std::size_t i = 0; i < n_named; ++i) draw.add_by_chance(named);
  if (out.kind == nameless) draw.add_by_chance(those_of(out.physics, nameless_unknowns()));
  if (out.kind == below_limit) draw.add_by_chance(named, {0.25, 0.2500001});
  if (out.kind != left_out) return;
  draw.add_in_turn(without_aliases(named), n_before(left_out, number));
  out.left_out = {out.effects.front().id};
}

Session session_of(const Physics physics, const RecordSet set, const std::uint64_t seed) {
  return {.takes = physics == Physics::finite_strain ? short_takes() : takes_of(set),
          .seed = seed,
          .has_wind_channel = has_wind_channel(set)};
}

signals::Dataset recorded(const Physics physics, const World& world, const Session& session) {
  const Structure& structure = structure_of(world.solid);
  if (physics == Physics::modes) return record_session(structure, world, session);
  SolidMotion motion(world);
  return record_session(motion, structure, world, session);
}

/// Takes of a simulation: it has no noise, and needs no held-out records.
Session simulated(Session session) {
  session.noise = false;
  session.has_wind_channel = true;
  std::erase_if(session.takes, [](const Take& take) {
    return take.split != signals::Split::fit || take.is_at_rest();
  });
  return session;
}

std::uint64_t seed_of_simulation(const std::uint64_t seed) {
  return seed * 100000 + 99999;
}

}  // namespace

CaseClass class_of(const std::size_t number) {
  return turns[number % turns.size()];
}

World plain_world(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  World world;
  world.joint.scale = usual_turn;
  world.moment_noise = quietest_moment * std::pow(loudest_in_quietest, uniform(random));
  world.acceleration_noise =
      quietest_accelerometer + (loudest_accelerometer - quietest_accelerometer) * uniform(random);
  world.noise_colour = 0.15 * uniform(random);
  return world;
}

TrialCase draw_case(const std::uint64_t seed, const std::size_t number, const Physics physics,
                    const Circumstances& circumstances, const double accuracy) {
  TrialCase out;
  out.physics = physics;
  out.circumstances = circumstances;
  out.accuracy = accuracy;
  out.kind = class_of(number);
  out.seed = seed * 100000 + number;
  std::mt19937_64 random(out.seed);
  out.session = session_of(physics, circumstances.set, out.seed);
  out.world = plain_world(random);
  out.world.moment_noise *= noise_factor(circumstances.set);
  std::mt19937_64 calibrations(stream_seed(seed, number, of_calibrations));
  draw_calibrations(out.world, circumstances.distance, calibrations);
  out.plain = out.world;
  add_effects(out, number, random);
  if (out.kind == calibration_only && circumstances.distance == Distance::exact)
    draw_calibrations(out.world, Distance::as_built, random);
  return out;
}

signals::Dataset records_of(const TrialCase& trial_case) {
  signals::Dataset out = recorded(trial_case.physics, trial_case.world, trial_case.session);
  if (trial_case.kind != wrong_metadata) return out;
  // Alternately a fan that was off, which only a measured wind shows, and a wrong period.
  const bool is_fan =
      trial_case.seed / turns.size() % 2 == 0 && trial_case.session.has_wind_channel;
  const bool has_low = trial_case.circumstances.set != RecordSet::one_level;
  for (signals::DatasetRecord& entry : out.records) {
    if (is_fan && entry.name == (has_low ? "base_low" : "base_high_2"))
      entry.excitation.wind = true;
    if (!is_fan && entry.name == "base_high") entry.period_samples = 1500;
  }
  return out;
}

std::vector<FurtherExperiment> further_experiments_of(const TrialCase& trial_case) {
  if (trial_case.physics == Physics::finite_strain) return {};
  return further_experiments(trial_case.circumstances.set);
}

std::vector<std::pair<std::string, signals::Dataset>> further_records_of(
    const TrialCase& trial_case) {
  constexpr std::uint64_t another_day = 50000;
  std::vector<std::pair<std::string, signals::Dataset>> out;
  for (const FurtherExperiment& experiment : further_experiments_of(trial_case))
    out.emplace_back(experiment.name,
                     record_session(structure_of(trial_case.world.solid), trial_case.world,
                                    {.takes = experiment.takes,
                                     .seed = trial_case.seed + another_day,
                                     .has_wind_channel = trial_case.session.has_wind_channel}));
  return out;
}

signals::Dataset simulated_records(const std::uint64_t seed, const Physics physics) {
  return recorded(physics, {},
                  simulated(session_of(physics, RecordSet::complete, seed_of_simulation(seed))));
}

signals::Dataset simulated_records(const std::uint64_t seed, const SimulationForm& form,
                                   const RecordSet set) {
  const World world;
  const Session session = simulated(session_of(Physics::modes, set, seed_of_simulation(seed)));
  if (form.hold == Hold::band_limited) return record_session(form.structure, world, session);
  HeldMotion motion(form.structure, world, form.hold);
  return record_session(motion, form.structure, world, session);
}

bool has_own_simulation(const Circumstances& circumstances) {
  return circumstances.form_error != FormError::zero || circumstances.set == RecordSet::two_files;
}

SimulationForm form_of(const TrialCase& trial_case) {
  return draw_form(structure_of({}), size_of(trial_case.circumstances.form_error),
                   stream_seed(trial_case.seed, 0, of_the_form));
}

}  // namespace vibrissa::trial
