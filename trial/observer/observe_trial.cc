// Upper bound on the accuracy of a diagnosis: the ideal Bayesian observer on sensors like those of
// a trial.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "fem/linalg/solver_session.h"
#include "signals/system/kept_memory.h"
#include "signals/system/progress.h"
#include "trial/generator/calibration_draw.h"
#include "trial/generator/circumstance_draw.h"
#include "trial/generator/gap_share.h"
#include "trial/generator/record_set.h"
#include "trial/generator/trial_case.h"
#include "trial/observer/ideal_observer.h"

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

/// Sensors with more than one remaining answer, and how many of them further experiments resolve:
/// then exactly one answer, the right one, remains.
struct FurtherTally {
  std::size_t undecided = 0;
  double by_any = 0.;     // resolved by at least one of the experiments
  double by_chance = 0.;  // mean over the experiments
  void add(const IdealObserver& observer, const ObservedSensor& sensor, std::size_t n_experiments) {
    std::size_t n_resolve = 0;
    for (std::size_t i = 1; i <= n_experiments; ++i) {
      const ObserverAnswer after = observer.answer(sensor, i);
      n_resolve += after.right && after.set_size == 1 ? 1 : 0;
    }
    ++undecided;
    by_any += n_resolve > 0 ? 1. : 0.;
    by_chance += static_cast<double>(n_resolve) / static_cast<double>(n_experiments);
  }
};

struct Options {
  std::size_t n_benches = 25;
  std::uint64_t seed = 1;
  bool life = false, further = false, json = false, quiet = false;
  std::array<double, 4> asked = trial::ObservedBench{}.asked;
  bool is_talkative() const { return !json && !quiet; }
};

struct Result {
  Tallies tallies{};
  std::map<std::string, Tallies> classes{};  // of the circumstances of life
  FurtherTally further{};
};

/// Takes of the usual session, followed by those of each further experiment.
struct Takes {
  std::vector<trial::Take> all{};
  std::vector<std::size_t> block_ends{};  // counted in frequency lines
  std::size_t n_further() const { return block_ends.size() - 1; }
};

Takes takes_of(const Options& options) {
  Takes out;
  std::size_t n_lines = 0;
  const auto add = [&](const std::vector<trial::Take>& takes) {
    for (const trial::Take& take : takes) {
      if (take.split != signals::Split::fit) continue;
      out.all.push_back(take);
      n_lines += take.n_samples / 2 - 1;
    }
    out.block_ends.push_back(n_lines);
  };
  add(trial::usual_takes());
  if (options.further)
    for (const trial::FurtherExperiment& experiment : trial::further_experiments())
      add(experiment.takes);
  return out;
}

void ask(const IdealObserver& observer, const Options& options, const Takes& takes,
         const std::vector<Tallies*>& tallies, std::mt19937_64& random, FurtherTally& further) {
  const char* names[] = {"none", "single", "pair", "triple"};
  for (std::size_t n_effects = 0; n_effects < 4; ++n_effects) {
    if (options.asked[n_effects] == 0.) continue;
    for (std::size_t i = 0; i < sensors_of_a_bench[n_effects]; ++i) {
      const ObservedSensor sensor = observer.draw(n_effects, random);
      if (sensor.least_gap_share < trial::least_gap_share) continue;
      const ObserverAnswer answer = observer.answer(sensor);
      for (Tallies* tally : tallies) {
        (*tally)[names[n_effects]].add(answer);
        if (n_effects == 1 && sensor.in_limits.front() >= well_above_limit)
          (*tally)["single at 3 limits and more"].add(answer);
      }
      if (options.further && answer.set_size > 1) further.add(observer, sensor, takes.n_further());
    }
  }
}

std::vector<trial::EffectLadder> ladders_of(const trial::UnexplainedChange& change,
                                            const Options& options) {
  signals::Progress progress("effects", trial::named_unknowns().size(), options.is_talkative());
  return trial::effect_ladders(change, [&] { progress.advance(); });
}

trial::World plain_design() {
  trial::World out;
  out.joint.scale = trial::usual_turn;
  return out;
}

Result observe(const Options& options) {
  const Takes takes = takes_of(options);
  const trial::UnexplainedChange change(plain_design(), {.takes = takes.all, .seed = options.seed});
  const std::vector<trial::EffectLadder> ladders = ladders_of(change, options);
  signals::Progress progress("benches", options.n_benches, options.is_talkative());
  std::mt19937_64 random(options.seed);
  const std::vector<trial::LineChange> unknown = trial::unknown_changes(
      change, trial::Distance::exact, trial::stated_accuracy(trial::FormError::zero));
  Result out;
  for (std::size_t i = 0; i < options.n_benches; ++i, progress.advance()) {
    const trial::World bench = trial::plain_world(random);
    const IdealObserver observer(
        ladders, change.noise(bench.moment_noise, bench.acceleration_noise),
        {.acceleration_noise = bench.acceleration_noise, .asked = options.asked}, unknown,
        takes.block_ends);
    ask(observer, options, takes, {&out.tallies}, random, out.further);
  }
  return out;
}

/// Benches of life: each with a set of records, a distance and a form error in turn; 63 have all
/// combinations. All benches of a set use the same ladders.
Result observe_life(const Options& options) {
  Result out;
  const std::vector<trial::RecordSet>& sets = trial::record_sets();
  for (std::size_t s = 0; s < std::min(sets.size(), options.n_benches); ++s) {
    const trial::Session session{.takes = trial::takes_of(sets[s]),
                                 .seed = options.seed,
                                 .has_wind_channel = trial::has_wind_channel(sets[s])};
    const trial::UnexplainedChange change(plain_design(), session);
    const std::vector<trial::EffectLadder> ladders = ladders_of(change, options);
    for (std::size_t i = s; i < options.n_benches; i += sets.size()) {
      std::mt19937_64 random(trial::stream_seed(options.seed, i, 1));
      const trial::World bench = trial::plain_world(random);
      const trial::Distance distance = trial::distances()[i % trial::distances().size()];
      const trial::FormError error =
          trial::form_errors()[i / trial::distances().size() % trial::form_errors().size()];
      trial::World at_distance = plain_design();
      trial::draw_calibrations(at_distance, distance, random);
      const IdealObserver observer(
          ladders,
          change.noise(bench.moment_noise * trial::noise_factor(sets[s]), bench.acceleration_noise),
          {.acceleration_noise = bench.acceleration_noise,
           .asks_calibrations = distance == trial::Distance::exact,
           .calibration_power = trial::power_of(change.of(at_distance, true)),
           .asked = options.asked},
          trial::unknown_changes(change, distance, stated_accuracy(error)));
      ask(observer, options, {},
          {&out.tallies, &out.classes["set: " + to_string(sets[s])],
           &out.classes["distance: " + to_string(distance)],
           &out.classes["form error: " + to_string(error)]},
          random, out.further);
    }
  }
  return out;
}

void print(const Tallies& tallies) {
  for (const auto& [name, tally] : tallies)
    std::printf("%-28s %5zu %6.3f %6.3f %6.3f %6.3f %5.2f\n", name.c_str(), tally.of,
                tally.share(static_cast<double>(tally.right)), tally.share(tally.said),
                tally.share(static_cast<double>(tally.among_three)),
                tally.share(static_cast<double>(tally.set_holds)),
                tally.share(static_cast<double>(tally.set_size)));
}

void print(const Result& result) {
  std::printf("%-28s %5s %6s %6s %6s %6s %5s\n", "", "n", "right", "stated", "top3", "in95",
              "size");
  print(result.tallies);
  for (const auto& [name, tallies] : result.classes) {
    std::printf("%s\n", name.c_str());
    print(tallies);
  }
  std::printf(
      "n: sensors; right: share of right answers; stated: their mean stated probability;\n"
      "top3: truth among the three most probable answers; in95: truth in the 95 %% set;\n"
      "size: mean number of answers in that set\n");
  if (const FurtherTally& further = result.further; further.undecided > 0)
    std::printf(
        "of %zu undecided sensors, share resolved by the best further experiment: %.3f, by a "
        "random one: %.3f\n",
        further.undecided, further.by_any / static_cast<double>(further.undecided),
        further.by_chance / static_cast<double>(further.undecided));
}

void print_json(const Result& result, const Options& options) {
  nlohmann::json out{{"schema", "vibrissa-ideal-observer-1"},
                     {"seed", options.seed},
                     {"life", options.life},
                     {"asked", options.asked}};
  for (const auto& [name, tally] : result.tallies) out["answers"][name] = tally.to_json();
  for (const auto& [of, tallies] : result.classes)
    for (const auto& [name, tally] : tallies) out["classes"][of][name] = tally.to_json();
  if (const FurtherTally& further = result.further; further.undecided > 0) {
    const double n = static_cast<double>(further.undecided);
    out["further"] = {{"undecided", further.undecided},
                      {"best_resolves", further.by_any / n},
                      {"by_chance_resolves", further.by_chance / n}};
  }
  std::cout << out.dump(1) << "\n";
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app(
      "Upper bound on accuracy (ideal Bayesian observer): accuracy of an observer who knows the "
      "form of every effect, the noise of the bench and the relative frequencies of all effects, "
      "on sensors like those of a blind trial.");
  Options options;
  app.add_option("--benches", options.n_benches, "Number of benches, each with 22 sensors")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of the random sensors")->capture_default_str();
  auto* further = app.add_flag("--further", options.further,
                               "When more than one answer remains, add each further experiment");
  app.add_flag(
         "--life", options.life,
         "Benches of \"trial make --life\": each with a set of records and a distance from the "
         "simulation and a form error in turn (63 benches have all combinations)")
      ->excludes(further);
  app.add_option("--asked", options.asked,
                 "Relative frequencies of 0, 1, 2, 3 true effects; 0: never")
      ->check(CLI::Range(0., 1e6))
      ->capture_default_str();
  app.add_flag("--json", options.json, "Machine-readable result on standard output");
  app.add_flag("-q,--quiet", options.quiet, "No progress bar");
  CLI11_PARSE(app, argc, argv);
  signals::keep_freed_memory();
  const fem::SolverSession session;
  const Result result = options.life ? observe_life(options) : observe(options);
  if (options.json)
    print_json(result, options);
  else
    print(result);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "observe_trial: " << error.what() << "\n";
  return 2;
}
