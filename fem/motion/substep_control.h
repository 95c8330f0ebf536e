#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace vibrissa::fem {

/// Options of adaptive substeps within a sampling interval: entries of the section "Transient" of
/// the case file.
struct SubstepOptions {
  double tolerance = 1e-3;             // "Time tolerance" [1]: upper bound of (T14.7)
  double least_displacement_m = 1e-5;  // "Least displacement": d of (T14.7)
  unsigned int most = 64;              // "Most substeps", the least number times a power of two

  /// Throws UserError with the entry when the tolerance or the displacement is not positive, or
  /// when the largest number is not the least number times a power of two.
  void check(unsigned int least) const;
};

/// Result of one sampling interval.
struct IntervalSteps {
  unsigned int substeps = 0;
  unsigned int n_rejected = 0;  // rejected tries with fewer substeps
  double error = 0.;  // (T14.7) [1]; above the tolerance only at the largest number of substeps
};

/// Summary over a record.
struct SubstepSummary {
  unsigned int smallest = 0, largest = 0;
  double mean = 0.;
  std::size_t n_rejected = 0;        // intervals that were repeated
  std::size_t n_over_tolerance = 0;  // although they had the largest number of substeps
};
SubstepSummary summarise(const std::vector<IntervalSteps>& intervals, double tolerance);

/// Selects the number of substeps of each sampling interval: the least number times a power of two.
/// The error of an interval is proportional to 1 / substeps^2. When the error is too large, the
/// number is doubled until the predicted error is half the tolerance; it is halved after several
/// consecutive intervals whose error allows it. Proven by tests/fem/motion/substep_control_test.cc
/// and adaptive_transient_test.cc.
class SubstepControl {
 public:
  /// Throws as SubstepOptions::check.
  SubstepControl(unsigned int least, const SubstepOptions& options);

  void begin_interval() { interval_ = {}; }
  /// Number for the next try.
  unsigned int substeps() const { return substeps_; }
  /// Reports the end of a try: the sum of the errors of its steps (T14.6) and the displacement,
  /// both as largest components over the whole solid. Returns whether the interval is accepted.
  bool accept(double error_m, double displacement_m);
  /// Reports a try without equilibrium. Returns whether another try is possible.
  bool refine();
  /// The interval that was accepted last.
  const IntervalSteps& interval() const { return interval_; }

  /// Saves and restores the state between two intervals.
  void add_to(std::map<std::string, double>& numbers) const;
  void restore(const std::map<std::string, double>& numbers);

 private:
  void coarsen_after_calm();
  void end_calm();

  unsigned int least_, substeps_;
  SubstepOptions options_;
  double largest_displacement_m_;
  unsigned int n_calm_ = 0;  // consecutive intervals for which half the substeps are enough
  double calm_error_ = 0.;   // the largest error of these intervals
  IntervalSteps interval_;
};

}  // namespace vibrissa::fem
