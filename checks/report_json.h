#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "checks/check_file.h"

namespace vibrissa::checks {

/// "vibrissa-check-1" (docs/recording.md). Proven by tests/checks/check_file_test.cc.
nlohmann::json check_json(const CheckResult& result);

/// Of one source the same; of several an array.
nlohmann::json check_json(std::span<const CheckResult> results);

}  // namespace vibrissa::checks
