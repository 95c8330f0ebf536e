#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {

/// An effect of the catalogue with its parameter values, and the reference values of the experiment
/// in which they were estimated.
struct KnownEffect {
  std::string id{};
  std::vector<double> values{};  // one per parameter
  Scales scales{};
};

/// A simulation updated by an earlier diagnosis: the nominal model and its known effects (also
/// calibration effects), in the order in which they extend it. A nominal model is an updated model
/// without effects. Proven by tests/diagnosis/model/updated_model_test.cc.
struct UpdatedModel {
  NominalModel nominal{};
  std::vector<KnownEffect> effects{};

  UpdatedModel() = default;
  UpdatedModel(NominalModel model,
               std::vector<KnownEffect> known = {})  // NOLINT: implicit on purpose
      : nominal(std::move(model)), effects(std::move(known)) {}

  /// Throws UserError for an effect that is not in the catalogue.
  Chain chain() const;
};

}  // namespace vibrissa::diagnosis
