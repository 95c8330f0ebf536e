#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/steady_state/harmonic_balance.h"

namespace vibrissa::diagnosis {

/// Is this record a response that is not proportional to its drive under the chain?
bool is_nonlinear_sweep(const Chain& chain, const PreparedRecord& record);

/// The steady states of a response under one chain, one for each of its lines. Where several are
/// stable, a real sweep may leave its branch before the branch ends, but does not return; and a
/// simulated branch may end up to late_jump (relative) too early, where its last state is held. The
/// line at which it jumps is the one that fits the measured magnitudes best. Proven by
/// tests/diagnosis/prediction/sweep_states_test.cc.
class SweepStates {
 public:
  /// Twice the usual accuracy of a simulation.
  static constexpr double late_jump = 0.02;

  SweepStates(const Chain& chain, const PreparedRecord& record);

  /// The reading [N m] at each line.
  const std::vector<Complex>& readings() const { return readings_; }
  /// The last line with several stable states, in the order of the sweep [Hz]: a sweep that stays
  /// on its branch jumps there. Nothing where all lines have one or the last has several.
  std::optional<double> branch_end_hz() const { return branch_end_hz_; }
  /// The same on the same branches under a chain that hardly differs: with the motion's error E,
  /// y - (dE / dy)^-1 (E_changed(y) - E(y)).
  std::vector<Complex> readings_of(const Chain& changed, const PreparedRecord& record) const;

 private:
  /// Error of the equations at a motion, and the inverse of its derivatives by the coordinates.
  struct Linearisation {
    Eigen::VectorXd error;
    Eigen::MatrixXd inverse;
  };
  const std::vector<Linearisation>& linearised(const PreparedRecord& record) const;

  Chain chain_;
  std::size_t highest_order_ = 1;
  std::optional<double> branch_end_hz_{};
  std::vector<PeriodicMotion> motions_;  // empty where the curve has no state at each line
  std::vector<Complex> readings_;
  mutable std::once_flag is_linearised_{};
  mutable std::vector<Linearisation> linearised_{};  // of each line, when first asked for
};

}  // namespace vibrissa::diagnosis
