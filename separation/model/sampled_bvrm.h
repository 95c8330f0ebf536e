#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// A model and the hold of the fit, when it is known. A simulation with another hold gives another
/// moment. Proven by tests/separation/model/sampled_bvrm_test.cc.
struct SampledBvrm {
  Bvrm model;
  std::optional<Hold> hold = std::nullopt;

  /// The given hold, else the hold of the fit, else first_order.
  Hold hold_or(const std::optional<Hold>& told) const;
};

/// JSON of the Bvrm, with "hold" when it is known.
nlohmann::json to_json(const SampledBvrm& sampled);
/// Throws UserError as bvrm_from_json, and for an unknown hold.
SampledBvrm sampled_bvrm_from_json(const nlohmann::json& json, const std::string& where);
SampledBvrm read_bvrm(const std::filesystem::path& file);
void write_bvrm(const std::filesystem::path& file, const SampledBvrm& sampled);

}  // namespace vibrissa::separation
