#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/table.h"
#include "separation/identify.h"

namespace vibrissa::apps {

/// {"modes": [{"frequency_hz", "frequency_sd_hz", "damping_ratio", "damping_sd",
/// "static_gain_kg_m",
///  "static_gain_sd_kg_m"}], "direct_term", "direct_term_sd", "fit_percent", "vaf_percent",
///  "order", "hold", "end"}.
nlohmann::json identification_json(const separation::Identification& identification);
report::Table identification_table(const separation::Identification& identification);

}  // namespace vibrissa::apps
