#pragma once

#include <optional>
#include <string>

#include "diagnosis/nominal_model.h"

namespace vibrissa::apps {

/// How a command takes the simulation: as a model or as records.
struct NominalInput {
  std::optional<std::string> model, simulation;

  /// The nominal model and the rate of the simulation's records, 0 when it is a model. Throws
  /// UserError unless one of the two is given, and what their readers throw.
  struct Nominal {
    diagnosis::NominalModel model;
    double sampling_rate_hz = 0.;
  };
  Nominal read(bool show_progress) const;
};

}  // namespace vibrissa::apps
