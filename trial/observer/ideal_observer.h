#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "trial/generator/effect_ladder.h"
#include "trial/generator/signature.h"
#include "trial/observer/box_integral.h"

namespace vibrissa::trial {

struct ObservedBench {
  double acceleration_noise = 0.;  // m/s^2
  /// Are effects asked that unknown calibrations imitate (is_a_calibration())?
  bool asks_calibrations = true;
  /// Power of the moment's change by this sensor's calibrations [(N m)^2 of unscaled bins].
  double calibration_power = 0.;
  /// Relative frequencies of 0, 1, 2, 3 true effects, which the observer knows.
  std::array<double, 4> asked{2., 9., 2., 1.};
};

/// A sensor as the observer sees it.
struct ObservedSensor {
  std::vector<std::size_t> unknowns{};  // indices of named_unknowns(), ascending
  std::vector<double> in_limits{};      // sizes in multiples of the detection limit
  double least_gap_share = 1.;          // of its effects that change means (gap_shares())
  /// Inner products of the records of each block with all signatures.
  std::vector<Eigen::VectorXd> seen{};
};

struct ObserverAnswer {
  std::vector<std::size_t> unknowns{};
  double probability = 0.;
  bool right = false, among_three = false;
  std::size_t set_size = 0;  // number of answers in the 95 % set
  bool set_holds = false;    // the truth is in the 95 % set
};

/// Ideal Bayesian observer, an upper bound on the accuracy of a diagnosis: it knows the form of
/// every effect, the noise of the bench, and the distribution of the number and sizes of effects,
/// and applies Bayes' rule over 0, 1, 2 and 3 effects. What differs between sensor and simulation
/// beside effects is drawn anew for each sensor and integrated out. Contributions of several
/// effects are assumed additive and piecewise linear between the sizes of a ladder; a change of a
/// variance is treated as a change of a mean with the variance without the effect. Proven by
/// tests/trial/observer/ideal_observer_test.cc.
class IdealObserver {
 public:
  /// Probabilities and sets of effects, the most probable first.
  using Posterior = std::vector<std::pair<double, std::vector<std::size_t>>>;

  /// noise: of each line of the ladders, from UnexplainedChange::noise. unknown: what differs
  /// between sensor and simulation beside effects; the observer knows how it is distributed, and
  /// detection limits allow for it. block_ends: end indices of the lines of the usual session,
  /// which determine the detection limits, and of each further experiment; empty: all lines belong
  /// to the usual session.
  IdealObserver(const std::vector<EffectLadder>& ladders, const std::vector<double>& noise,
                const ObservedBench& bench, const std::vector<LineChange>& unknown = {},
                std::vector<std::size_t> block_ends = {});

  ObservedSensor draw(std::size_t n_effects, std::mt19937_64& random) const;
  /// Answer from the usual session plus the further experiment with number 1, 2 ..; 0: none.
  ObserverAnswer answer(const ObservedSensor& sensor, std::size_t further = 0) const;

 private:
  /// A section between two sizes of a ladder, for one sign: start + t edge, t in 0..1.
  struct Step {
    std::size_t unknown = 0, first = 0, second = 0;  // indices of signatures
    double sign = 1., log_prior = 0.;
    double low = 1., high = 1.;  // in multiples of the detection limit
  };
  struct Path {
    std::size_t unknown = 0, first_step = 0, n_steps = 0;
  };

  /// Inner products of the starts and edges of all sections in a session, whose noise is wider by
  /// the unknown changes.
  struct View {
    Eigen::MatrixXd starts, starts_edges, edges;
    /// What to subtract from the records' products with the signatures, by those with the unknown
    /// changes: S^T N (1 + N^T N)^-1 (Woodbury's identity).
    Eigen::MatrixXd correction;
  };
  /// Inner products of a sensor's records with the sections.
  struct Seen {
    const View& view;
    Eigen::VectorXd start, edge;
  };

  void add_ladder(const EffectLadder& ladder, const std::vector<double>& noise,
                  const std::vector<double>& noise_of_usual, const WidenedNoise& widened);
  void spread_priors();
  View view_of(const Eigen::MatrixXd& inner) const;
  template <std::size_t n>
  BoxNormal<n> likelihood(const std::array<std::size_t, n>& steps, const Seen& seen) const;
  Posterior posterior_of(const Seen& seen) const;

  ObservedBench bench_;
  std::vector<Eigen::VectorXd> signatures_;
  std::vector<double> amplitudes_;  // root of the moment's power; 0: changes variances alone
  std::vector<Step> steps_;
  std::vector<Path> paths_;
  std::vector<std::size_t> there_;  // effects that are detectable on this bench
  std::vector<std::size_t> block_ends_;
  std::vector<Eigen::MatrixXd> inner_, noise_root_;  // of each block; unknown changes come last
  std::vector<View> views_;  // of the first block alone, and combined with each other block
};

}  // namespace vibrissa::trial
