#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fem/motion/energy_balance.h"
#include "fem/motion/substep_control.h"
#include "fem/sensor/base_moment.h"

namespace vibrissa::fem {

/// State of a transient between two samples. A run with the same number of processes resumes from
/// it bit for bit.
struct TransientMemory {
  std::map<std::string, Vector> vectors{};
  std::map<std::string, double> numbers{};
  std::map<std::string, std::vector<double>> own{};  // of this process
};

/// Numbers of steps, iterations and factorisations since the start.
struct StepCount {
  std::size_t n_steps = 0, n_iterations = 0, n_factorisations = 0;
};

/// A sensor under the inputs of a record, linear or at finite strain.
class DrivenSensor {
 public:
  virtual ~DrivenSensor() = default;

  /// Advances through the sampling interval that begins at a sample.
  virtual void advance(std::size_t sample) = 0;

  virtual const SolidState& state() const = 0;
  /// The base moment by the two routes of BaseMoment.
  virtual std::array<double, 3> moment_by_reactions() const = 0;
  virtual std::array<double, 3> moment_by_balance() const = 0;
  /// Nothing for the linear model.
  virtual std::optional<EnergyBalance> energy() const = 0;
  virtual StepCount count() const = 0;
  /// The last sampling interval, for a model with adaptive substeps.
  virtual std::optional<IntervalSteps> interval() const = 0;

  virtual TransientMemory memory() const = 0;
  /// Continues from a saved state at a sample.
  virtual void restore(const TransientMemory& memory, std::size_t sample) = 0;
};

}  // namespace vibrissa::fem
