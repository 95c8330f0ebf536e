#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// A model and how the input ran between the samples that it was fitted to, where that is known.
/// Who simulates it otherwise from samples like those gets another moment. Proven by
/// tests/separation/model/sampled_bvrm_test.cc.
struct SampledBvrm {
  Bvrm model;
  std::optional<Hold> hold = std::nullopt;

  /// As told, else as it was for the fit, else first order.
  Hold hold_or(const std::optional<Hold>& told) const;
};

/// As that of a Bvrm, with "hold" where it is known.
nlohmann::json to_json(const SampledBvrm& sampled);
/// Throws UserError as bvrm_from_json, and for a hold that is none.
SampledBvrm sampled_bvrm_from_json(const nlohmann::json& json, const std::string& where);
SampledBvrm read_bvrm(const std::filesystem::path& file);
void write_bvrm(const std::filesystem::path& file, const SampledBvrm& sampled);

}  // namespace vibrissa::separation
