#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "trial/generator/effect_ladder.h"
#include "trial/observer/box_integral.h"

namespace vibrissa::trial {

struct ObservedBench {
  double acceleration_noise = 0.;  // m/s^2
  /// Every sensor is a little off in modulus, damping, gain and drag, and the observer allows for
  /// it; else all that is not asked is as simulated, and the observer knows.
  bool as_built = false;
  /// How often none, one, two and three effects are asked, to each other, as the observer knows.
  std::array<double, 4> asked{2., 9., 2., 1.};
};

/// A sensor as the observer sees it.
struct ObservedSensor {
  std::vector<std::size_t> unknowns{};  // of named_unknowns(), ascending
  std::vector<double> in_limits{};      // size of each
  /// Inner products of the records of each block with all signatures.
  std::vector<Eigen::VectorXd> seen{};
};

struct ObserverAnswer {
  std::vector<std::size_t> unknowns{};
  double probability = 0.;
  bool right = false, among_three = false;
  std::size_t set_size = 0;  // answers that hold 95 %
  bool set_holds = false;    // the truth is among them
};

/// Who knows the form of every effect, the noise of the bench, how often each answer is asked and
/// how large it then is. By Bayes's rule over none, one, two and three effects: whoever knows less
/// names fewer of them rightly. What effects add to the records is taken to add up, and to go
/// straight from step to step; a change of a variance is seen as one of a mean, of the variance
/// that it has without. Proven by tests/trial/observer/ideal_observer_test.cc.
class IdealObserver {
 public:
  /// Probability and set of unknowns, the likeliest first.
  using Posterior = std::vector<std::pair<double, std::vector<std::size_t>>>;

  /// noise: of each line of the ladders, UnexplainedChange::noise. block_ends: where the lines of
  /// the usual session end, which make the detection limits, and those of each further experiment,
  /// for which sensors must not be as built; nothing: all are of the usual one.
  IdealObserver(const std::vector<EffectLadder>& ladders, const std::vector<double>& noise,
                const ObservedBench& bench, std::vector<std::size_t> block_ends = {});

  ObservedSensor draw(std::size_t n_effects, std::mt19937_64& random) const;
  /// By the usual session, and further experiment number 1, 2 ..; 0: none.
  ObserverAnswer answer(const ObservedSensor& sensor, std::size_t further = 0) const;

 private:
  /// A step of a ladder, of one sign: start + t edge, t in 0..1.
  struct Step {
    std::size_t unknown = 0, first = 0, second = 0;  // signatures
    double sign = 1., log_prior = 0.;
    double low = 1., high = 1.;  // in limits
  };
  struct Path {
    std::size_t unknown = 0, first_step = 0, n_steps = 0;
  };

  /// What a session shows of the steps: inner products of their starts and edges.
  struct View {
    Eigen::MatrixXd starts, starts_edges, edges;
  };
  /// What is seen along the steps of a sensor.
  struct Seen {
    const View& view;
    Eigen::VectorXd start, edge;
  };

  void add_ladder(const EffectLadder& ladder, const std::vector<double>& noise);
  void spread_priors();
  void allow_for_building(const std::vector<EffectLadder>& ladders,
                          const std::vector<double>& noise);
  View view_of(const Eigen::MatrixXd& inner) const;
  template <std::size_t n>
  BoxNormal<n> likelihood(const std::array<std::size_t, n>& steps, const Seen& seen) const;
  Posterior posterior_of(const Seen& seen) const;

  ObservedBench bench_;
  std::vector<Eigen::VectorXd> signatures_;
  std::vector<Step> steps_;
  std::vector<Path> paths_;
  std::vector<std::size_t> there_;  // unknowns that this bench can show
  std::vector<std::size_t> block_ends_;
  std::vector<Eigen::MatrixXd> inner_, noise_root_;  // of each block
  std::vector<View> views_;                          // of the first block alone and with each other
};

}  // namespace vibrissa::trial
