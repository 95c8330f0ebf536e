// How often could anyone be right? The ideal observer asked about sensors like those of a trial.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "benchmarks/trial/ideal_observer.h"
#include "benchmarks/trial/trial_case.h"
#include "fem/solver_session.h"
#include "signals/kept_memory.h"
#include "signals/progress.h"

namespace {

using namespace vibrissa;
using trial::IdealObserver, trial::ObservedSensor, trial::ObserverAnswer;

constexpr std::size_t sensors_of_a_bench[] = {2, 10, 6, 4};  // by number of effects
constexpr double well_above_limit = 3.;

struct Tally {
  std::size_t of = 0, right = 0, among_three = 0, set_holds = 0, set_size = 0;
  double said = 0.;
  void add(const ObserverAnswer& answer) {
    ++of;
    right += answer.right;
    among_three += answer.among_three;
    set_holds += answer.set_holds;
    set_size += answer.set_size;
    said += answer.probability;
  }
  double share(double hits) const { return hits / static_cast<double>(of); }
  nlohmann::json to_json() const {
    return {{"of", of},
            {"right", share(static_cast<double>(right))},
            {"right_said", share(said)},
            {"right_among_three", share(static_cast<double>(among_three))},
            {"set_holds", share(static_cast<double>(set_holds))},
            {"mean_set_size", share(static_cast<double>(set_size))}};
  }
};

using Tallies = std::map<std::string, Tally>;

void ask(const IdealObserver& observer, const std::array<double, 4>& asked, std::mt19937_64& random,
         Tallies& tallies) {
  const char* names[] = {"none", "single", "pair", "triple"};
  for (std::size_t n_effects = 0; n_effects < 4; ++n_effects)
    for (std::size_t i = 0; asked[n_effects] > 0. && i < sensors_of_a_bench[n_effects]; ++i) {
      const ObservedSensor sensor = observer.draw(n_effects, random);
      const ObserverAnswer answer = observer.answer(sensor);
      tallies[names[n_effects]].add(answer);
      if (n_effects == 1 && sensor.in_limits.front() >= well_above_limit)
        tallies["single at 3 limits and more"].add(answer);
    }
}

void print(const Tallies& tallies) {
  std::printf("%-28s %5s %6s %6s %6s %6s %5s\n", "", "of", "right", "said", "first3", "set95",
              "size");
  for (const auto& [name, tally] : tallies)
    std::printf("%-28s %5zu %6.3f %6.3f %6.3f %6.3f %5.2f\n", name.c_str(), tally.of,
                tally.share(static_cast<double>(tally.right)), tally.share(tally.said),
                tally.share(static_cast<double>(tally.among_three)),
                tally.share(static_cast<double>(tally.set_holds)),
                tally.share(static_cast<double>(tally.set_size)));
}

void print_json(const Tallies& tallies, const std::uint64_t seed, const bool as_built,
                const std::array<double, 4>& asked) {
  nlohmann::json out{{"schema", "vibrissa-ideal-observer-1"},
                     {"seed", seed},
                     {"as_built", as_built},
                     {"asked", asked}};
  for (const auto& [name, tally] : tallies) out["answers"][name] = tally.to_json();
  std::cout << out.dump(1) << "\n";
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app(
      "How often could anyone be right? Asks an observer who knows the form of every effect, the "
      "noise of the bench and how often what is asked, about sensors like those of a blind trial.");
  std::size_t n_benches = 25;
  std::uint64_t seed = 1;
  bool as_built = false, json = false, quiet = false;
  std::array<double, 4> asked{2., 9., 2., 1.};
  app.add_option("--benches", n_benches, "How many, of 22 sensors each")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", seed, "All sensors follow from it")->capture_default_str();
  app.add_flag("--as-built", as_built,
               "Every sensor is a little off in modulus, damping, gain and drag");
  app.add_option("--asked", asked,
                 "How often none, one, two and three effects are asked, to each other; 0: never")
      ->check(CLI::Range(0., 1e6))
      ->capture_default_str();
  app.add_flag("--json", json, "Machine-readable result on standard output");
  app.add_flag("-q,--quiet", quiet, "No progress bar");
  CLI11_PARSE(app, argc, argv);

  signals::keep_freed_memory();
  const fem::SolverSession session;
  trial::World plain;
  plain.joint.scale = trial::usual_turn;
  const trial::UnexplainedChange change(plain, {.takes = trial::usual_takes(), .seed = seed});
  std::vector<trial::EffectLadder> ladders;
  {
    signals::Progress progress("effects", trial::named_unknowns().size(), !json && !quiet);
    ladders = trial::climb_ladders(change, [&] { progress.advance(); });
  }
  signals::Progress progress("benches", n_benches, !json && !quiet);
  std::mt19937_64 random(seed);
  Tallies tallies;
  for (std::size_t i = 0; i < n_benches; ++i, progress.advance()) {
    const trial::World bench = trial::plain_world(random);
    ask(IdealObserver(
            ladders, change.noise(bench.moment_noise, bench.acceleration_noise),
            {.acceleration_noise = bench.acceleration_noise, .as_built = as_built, .asked = asked}),
        asked, random, tallies);
  }
  if (json)
    print_json(tallies, seed, as_built, asked);
  else
    print(tallies);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "observe_trial: " << error.what() << "\n";
  return 2;
}
