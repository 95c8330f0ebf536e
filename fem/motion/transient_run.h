#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fem/motion/driven_sensor.h"
#include "fem/motion/moment_record.h"

namespace vibrissa::fem {

struct TransientOutput : MomentRecord {
  std::vector<EnergyBalance> energy;     // at every sample; empty for the linear model
  std::vector<IntervalSteps> intervals;  // only with adaptive substeps
  StepCount count;
};

/// Called at every sample with its index and state.
using TransientObserver = std::function<void(std::size_t, const SolidState&)>;

/// A driven sensor and its record so far; the first sample is the start. Proven by
/// tests/fem/motion/linear_transient_test.cc, nonlinear_transient_test.cc and checkpoint_test.cc.
class TransientRun {
 public:
  /// axial: direction of motion, in whose plane the base moment acts; both_routes: whether the two
  /// routes are compared.
  TransientRun(std::unique_ptr<DrivenSensor> sensor, std::size_t n_samples,
               const std::array<double, 3>& axial, bool both_routes);

  std::size_t n_samples() const { return n_samples_; }
  std::size_t n_done() const { return output_.base_moment.size(); }
  bool is_done() const { return n_done() == n_samples_; }
  /// Advances to the next sample.
  void advance();

  const DrivenSensor& sensor() const { return *sensor_; }
  const TransientOutput& output() const { return output_; }
  /// Continues from the output of an earlier run and the saved state at its last sample.
  void restore(const TransientMemory& memory, TransientOutput output);

 private:
  void record();

  std::unique_ptr<DrivenSensor> sensor_;
  std::size_t n_samples_;
  std::array<double, 3> axial_;
  bool both_routes_;
  TransientOutput output_;
};

/// Simulates the whole record.
TransientOutput run_to_the_end(TransientRun run, const TransientObserver& observer);

}  // namespace vibrissa::fem
