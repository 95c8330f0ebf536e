#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {

/// An effect of the catalogue with its parameters' values, and the magnitudes of the experiment
/// that they were found in.
struct KnownEffect {
  std::string id{};
  std::vector<double> values{};  // of every parameter
  Scales scales{};
};

/// A simulation with what an earlier diagnosis has found: the nominal model and the effects that
/// are known to be there, calibrations among them, in the order in which they extend it. A nominal
/// model is one without effects. Proven by tests/diagnosis/model/updated_model_test.cc.
struct UpdatedModel {
  NominalModel nominal{};
  std::vector<KnownEffect> effects{};

  UpdatedModel() = default;
  UpdatedModel(NominalModel model, std::vector<KnownEffect> known = {})  // NOLINT: meant to convert
      : nominal(std::move(model)), effects(std::move(known)) {}

  /// Throws UserError for an effect that the catalogue has not.
  Chain chain() const;
};

}  // namespace vibrissa::diagnosis
