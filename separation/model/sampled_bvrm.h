#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "separation/model/input_hold.h"
#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// What the identification said of its model (separation/verdict/verdict.h).
struct StatedVerdict {
  bool usable = false;
  std::string sentence;
};

/// A model, the hold of the fit and the verdict on it, when they are known. A simulation with
/// another hold gives another moment. Proven by tests/separation/model/sampled_bvrm_test.cc.
struct SampledBvrm {
  Bvrm model;
  std::optional<Hold> hold = std::nullopt;
  std::optional<StatedVerdict> verdict = std::nullopt;

  /// The given hold, else the hold of the fit, else first_order.
  Hold hold_or(const std::optional<Hold>& told) const;
  /// What a user of a model that is not usable must know; empty for others.
  std::string warning() const;
};

/// JSON of the Bvrm, with "hold", "usable" and "verdict" when they are known.
nlohmann::json to_json(const SampledBvrm& sampled);
/// Throws UserError as bvrm_from_json, and for an unknown hold or a verdict that is none.
SampledBvrm sampled_bvrm_from_json(const nlohmann::json& json, const std::string& where);
SampledBvrm read_bvrm(const std::filesystem::path& file);
void write_bvrm(const std::filesystem::path& file, const SampledBvrm& sampled);

}  // namespace vibrissa::separation
