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

/// What a transient remembers between two samples: enough to go on from there bit for bit, on the
/// same number of processes.
struct TransientMemory {
  std::map<std::string, Vector> vectors{};
  std::map<std::string, double> numbers{};
  std::map<std::string, std::vector<double>> own{};  // of this process
};

/// Work of an integrator since its start.
struct StepCount {
  std::size_t n_steps = 0, n_iterations = 0, n_factorisations = 0;
};

/// A sensor driven through a record, linear or at finite strain.
class DrivenSensor {
 public:
  virtual ~DrivenSensor() = default;

  /// Through the interval that begins at a sample.
  virtual void advance(std::size_t sample) = 0;

  virtual const SolidState& state() const = 0;
  /// As BaseMoment's two routes.
  virtual std::array<double, 3> moment_by_reactions() const = 0;
  virtual std::array<double, 3> moment_by_balance() const = 0;
  /// Nothing for the linear model.
  virtual std::optional<EnergyBalance> energy() const = 0;
  virtual StepCount count() const = 0;
  /// The interval that was gone through last, of a model that chooses its substeps.
  virtual std::optional<IntervalSteps> interval() const = 0;

  virtual TransientMemory memory() const = 0;
  /// Goes on from a memory at a sample.
  virtual void restore(const TransientMemory& memory, std::size_t sample) = 0;
};

}  // namespace vibrissa::fem
