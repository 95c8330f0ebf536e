#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace vibrissa::fem {

/// How finely a transient that chooses its own substeps goes through a sample interval: entries of
/// the case file's section "Transient".
struct SubstepOptions {
  double tolerance = 1e-3;             // "Time tolerance" [1]: the most of (T14.7)
  double least_displacement_m = 1e-5;  // "Least displacement": d of (T14.7)
  unsigned int most = 64;              // "Most substeps", a power of two times the least number

  /// Throws UserError naming the entry for a tolerance or a displacement that is not positive, and
  /// a most number that doubling the least one does not lead to.
  void check(unsigned int least) const;
};

/// How a sample interval was gone through.
struct IntervalSteps {
  unsigned int substeps = 0;
  unsigned int n_rejected = 0;  // tries before, with fewer substeps
  double error = 0.;            // (T14.7) [1]; above the tolerance only at the most substeps
};

/// Of a record.
struct SubstepSummary {
  unsigned int smallest = 0, largest = 0;
  double mean = 0.;
  std::size_t n_rejected = 0;        // intervals that were gone through anew
  std::size_t n_over_tolerance = 0;  // although at the most substeps
};
SubstepSummary summarise(const std::vector<IntervalSteps>& intervals, double tolerance);

/// Chooses the substeps of one sample interval after another, in powers of two times the least
/// number. The error of an interval falls with their square: one that is too large asks for as many
/// as should halve the tolerance; fewer are taken once several intervals in turn would have borne
/// them. Proven by tests/fem/motion/substep_control_test.cc and adaptive_transient_test.cc.
class SubstepControl {
 public:
  /// Throws as SubstepOptions::check.
  SubstepControl(unsigned int least, const SubstepOptions& options);

  void begin_interval() { interval_ = {}; }
  /// Of the next try.
  unsigned int substeps() const { return substeps_; }
  /// A try came to its end with this sum of its steps' errors (T14.6), this far from the reference:
  /// whether it stands. Largest components over the whole body.
  bool accept(double error_m, double displacement_m);
  /// A try found no balance: whether there is another one.
  bool refine();
  /// The interval that was accepted last.
  const IntervalSteps& interval() const { return interval_; }

  /// What it remembers between two intervals, and back.
  void add_to(std::map<std::string, double>& numbers) const;
  void restore(const std::map<std::string, double>& numbers);

 private:
  void coarsen_after_calm();
  void end_calm();

  unsigned int least_, substeps_;
  SubstepOptions options_;
  double largest_displacement_m_;
  unsigned int n_calm_ = 0;  // intervals in turn that half the substeps would have done for
  double calm_error_ = 0.;   // the largest of theirs
  IntervalSteps interval_;
};

}  // namespace vibrissa::fem
