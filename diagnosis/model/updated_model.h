#pragma once

#include <filesystem>
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

/// Schema of the files; it distinguishes them from other models.
inline const std::string updated_model_schema = "vibrissa-updated-model-1";

/// The model as JSON: modes, direct terms, the joint's share, effects with named values, units and
/// scales.
std::string updated_model_json(const UpdatedModel& model);

/// Throws UserError with the file and the place of a missing or out-of-range entry, and with the
/// known names. Proven by tests/diagnosis/model/updated_model_test.cc.
UpdatedModel read_updated_model(const std::filesystem::path& file);

/// Is the file a JSON document of this schema? False for any other file.
bool is_updated_model(const std::filesystem::path& file);

}  // namespace vibrissa::diagnosis
