#include "fem/motion/substep_control.h"

#include <algorithm>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::fem {

namespace {

// Doubling the substeps divides the error by this.
constexpr double gain = 4.;
// Target share of the tolerance after a change of substeps.
constexpr double aim = 0.5;
// Each change needs a new tangent, so a short quiet part of an oscillation should cause no change.
constexpr unsigned int enough_calm = 8;

void check_positive(const double value, const std::string& entry) {
  if (!(value > 0.))
    throw signals::UserError("Transient/" + entry + " = " + signals::to_text(value) +
                             ": must be more than 0");
}

}  // namespace

void SubstepOptions::check(const unsigned int least) const {
  check_positive(tolerance, "Time tolerance");
  check_positive(least_displacement_m, "Least displacement");
  unsigned int reached = std::max(least, 1u);
  while (reached <= most / 2) reached *= 2;
  if (reached != most)
    throw signals::UserError("Transient/Most substeps = " + std::to_string(most) +
                             ": must be Transient/Substeps = " + std::to_string(least) +
                             " times 1, 2, 4 or another power of two");
}

SubstepSummary summarise(const std::vector<IntervalSteps>& intervals, const double tolerance) {
  SubstepSummary summary;
  if (intervals.empty()) return summary;
  summary.smallest = intervals.front().substeps;
  for (const IntervalSteps& interval : intervals) {
    summary.smallest = std::min(summary.smallest, interval.substeps);
    summary.largest = std::max(summary.largest, interval.substeps);
    summary.mean += interval.substeps;
    if (interval.n_rejected > 0) ++summary.n_rejected;
    if (interval.error > tolerance) ++summary.n_over_tolerance;
  }
  summary.mean /= static_cast<double>(intervals.size());
  return summary;
}

SubstepControl::SubstepControl(const unsigned int least, const SubstepOptions& options)
    : least_(least),
      substeps_(least),
      options_(options),
      largest_displacement_m_(options.least_displacement_m) {
  options.check(least);
}

bool SubstepControl::accept(const double error_m, const double displacement_m) {
  const double largest = std::max(largest_displacement_m_, displacement_m);
  double error = error_m / largest;
  if (error > options_.tolerance && substeps_ < options_.most) {
    end_calm();
    do {
      substeps_ *= 2;
      error /= gain;
    } while (error > aim * options_.tolerance && substeps_ < options_.most);
    ++interval_.n_rejected;
    return false;
  }
  largest_displacement_m_ = largest;
  interval_.substeps = substeps_;
  interval_.error = error;
  coarsen_after_calm();
  return true;
}

void SubstepControl::coarsen_after_calm() {
  const auto halves = [&](const double error) {
    return substeps_ > least_ && gain * error <= aim * options_.tolerance;
  };
  if (!halves(interval_.error)) {
    end_calm();
    return;
  }
  ++n_calm_;
  calm_error_ = std::max(calm_error_, interval_.error);
  if (n_calm_ < enough_calm) return;
  for (; halves(calm_error_); calm_error_ *= gain) substeps_ /= 2;
  end_calm();
}

void SubstepControl::end_calm() {
  n_calm_ = 0;
  calm_error_ = 0.;
}

bool SubstepControl::refine() {
  if (substeps_ == options_.most) return false;
  substeps_ *= 2;
  end_calm();
  ++interval_.n_rejected;
  return true;
}

void SubstepControl::add_to(std::map<std::string, double>& numbers) const {
  numbers["substeps"] = substeps_;
  numbers["calm_intervals"] = n_calm_;
  numbers["calm_error"] = calm_error_;
  numbers["largest_displacement_m"] = largest_displacement_m_;
}

void SubstepControl::restore(const std::map<std::string, double>& numbers) {
  substeps_ = static_cast<unsigned int>(numbers.at("substeps"));
  n_calm_ = static_cast<unsigned int>(numbers.at("calm_intervals"));
  calm_error_ = numbers.at("calm_error");
  largest_displacement_m_ = numbers.at("largest_displacement_m");
}

}  // namespace vibrissa::fem
