#include "trial/generator/trial_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "trial/generator/effect_draw.h"
#include "trial/plant/solid_motion.h"

namespace vibrissa::trial {
namespace {

using enum CaseClass;
/// Cycle of twenty cases; single effects are the most frequent.
constexpr std::array turns{single,           pair,       none, single,   nameless, single,
                           left_out,         single,     pair, single,   triple,   single,
                           calibration_only, single,     none, left_out, single,   wrong_metadata,
                           nameless,         below_limit};

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
  const std::vector<Unknown> named = those_of(out.physics, named_unknowns());
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

void take_as_built(World& world, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto off = [&](double deviation) {
    return 1. + deviation * std::clamp(normal(random), -2., 2.);
  };
  world.solid.silicone_modulus = off(built_modulus);
  world.damping = off(built_damping);
  world.sensor_gain = off(built_gain);
  world.drag = off(built_drag);
}

std::vector<Take> takes_of(const Physics physics) {
  if (physics == Physics::finite_strain) return short_takes();
  std::vector<Take> out = usual_takes();
  for (const Take& take : transfer_takes()) out.push_back(take);
  return out;
}

signals::Dataset recorded(const Physics physics, const World& world, const Session& session) {
  const Structure& structure = structure_of(world.solid);
  if (physics == Physics::modes) return record_session(structure, world, session);
  SolidMotion motion(world);
  return record_session(motion, structure, world, session);
}

}  // namespace

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

TrialCase draw_case(const std::uint64_t seed, const std::size_t number, const Physics physics) {
  TrialCase out;
  out.physics = physics;
  out.kind = turns[number % turns.size()];
  out.seed = seed * 100000 + number;
  std::mt19937_64 random(out.seed);
  out.session = {.takes = takes_of(physics), .seed = out.seed};
  out.world = plain_world(random);
  add_effects(out, number, random);
  if (out.kind == calibration_only) take_as_built(out.world, random);
  return out;
}

signals::Dataset records_of(const TrialCase& trial_case) {
  signals::Dataset out = recorded(trial_case.physics, trial_case.world, trial_case.session);
  if (trial_case.kind != wrong_metadata) return out;
  // Alternately a fan that was off and a wrong period.
  if (trial_case.seed / turns.size() % 2 == 0) {
    for (signals::DatasetRecord& entry : out.records)
      if (entry.name == "base_low") entry.excitation.wind = true;
  } else {
    for (signals::DatasetRecord& entry : out.records)
      if (entry.name == "base_high") entry.period_samples = 1500;
  }
  return out;
}

std::vector<FurtherExperiment> further_experiments(const Physics physics) {
  if (physics == Physics::finite_strain) return {};
  return further_experiments();
}

std::vector<std::pair<std::string, signals::Dataset>> further_records_of(
    const TrialCase& trial_case) {
  constexpr std::uint64_t another_day = 50000;
  std::vector<std::pair<std::string, signals::Dataset>> out;
  for (const FurtherExperiment& experiment : further_experiments(trial_case.physics))
    out.emplace_back(
        experiment.name,
        record_session(structure_of(trial_case.world.solid), trial_case.world,
                       {.takes = experiment.takes, .seed = trial_case.seed + another_day}));
  return out;
}

signals::Dataset simulated_records(const std::uint64_t seed, const Physics physics) {
  World world;
  Session session{.takes = takes_of(physics), .seed = seed * 100000 + 99999, .noise = false};
  std::erase_if(session.takes, [](const Take& take) {
    return take.split != signals::Split::fit || take.is_at_rest();
  });
  return recorded(physics, world, session);
}

}  // namespace vibrissa::trial
