#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fem/motion/driven_sensor.h"
#include "fem/motion/moment_record.h"

namespace vibrissa::fem {

struct TransientOutput : MomentRecord {
  std::vector<EnergyBalance> energy;     // at every sample; none of the linear model
  std::vector<IntervalSteps> intervals;  // where their substeps were chosen
  StepCount count;
};

/// Called at every sample with its index and the state there.
using TransientObserver = std::function<void(std::size_t, const SolidState&)>;

/// A driven sensor with the record that it has left so far; the sample at the start is its first.
/// Proven by tests/fem/motion/linear_transient_test.cc, nonlinear_transient_test.cc and
/// checkpoint_test.cc.
class TransientRun {
 public:
  /// axial: direction of the base moment's motion; both_routes: whether moments are compared.
  TransientRun(std::unique_ptr<DrivenSensor> sensor, std::size_t n_samples,
               const std::array<double, 3>& axial, bool both_routes);

  std::size_t n_samples() const { return n_samples_; }
  std::size_t n_done() const { return output_.base_moment.size(); }
  bool is_done() const { return n_done() == n_samples_; }
  /// To the next sample.
  void advance();

  const DrivenSensor& sensor() const { return *sensor_; }
  const TransientOutput& output() const { return output_; }
  /// Goes on from an earlier run's output and the memory at its last sample.
  void restore(const TransientMemory& memory, TransientOutput output);

 private:
  void record();

  std::unique_ptr<DrivenSensor> sensor_;
  std::size_t n_samples_;
  std::array<double, 3> axial_;
  bool both_routes_;
  TransientOutput output_;
};

/// All of it.
TransientOutput run_to_the_end(TransientRun run, const TransientObserver& observer);

}  // namespace vibrissa::fem
