#pragma once

#include <filesystem>
#include <string>

#include "diagnosis/model/updated_model.h"

namespace vibrissa::diagnosis {

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
