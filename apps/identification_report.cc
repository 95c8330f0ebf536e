#include "apps/identification_report.h"

#include <nlohmann/json.hpp>

namespace vibrissa::apps {

nlohmann::json identification_json(const separation::Identification& identification) {
  nlohmann::json modes = nlohmann::json::array();
  for (const auto& mode : identification.fit.modes) {
    modes.push_back({{"frequency_hz", mode.frequency_hz.value},
                     {"frequency_sd_hz", mode.frequency_hz.standard_deviation},
                     {"damping_ratio", mode.damping_ratio.value},
                     {"damping_sd", mode.damping_ratio.standard_deviation},
                     {"static_gain_kg_m", mode.static_gain_kg_m.value},
                     {"static_gain_sd_kg_m", mode.static_gain_kg_m.standard_deviation}});
  }
  return {{"modes", modes},
          {"direct_term", identification.fit.direct_term_kg_m.value},
          {"direct_term_sd", identification.fit.direct_term_kg_m.standard_deviation},
          {"fit_percent", identification.held_out_fit_percent},
          {"vaf_percent", identification.held_out_vaf_percent},
          {"order", identification.order},
          {"hold", separation::to_string(identification.hold)},
          {"end", separation::to_string(identification.fit.end)}};
}

report::Table identification_table(const separation::Identification& identification) {
  report::Table table({{"mode", ""},
                       {"frequency", "Hz", 6},
                       {"+- sd", "Hz", 2},
                       {"damping ratio", ""},
                       {"+- sd", "", 2},
                       {"static gain", "kg m"},
                       {"+- sd", "kg m", 2}});
  std::size_t number = 0;
  for (const auto& mode : identification.fit.modes) {
    table.add_row({++number, mode.frequency_hz.value, mode.frequency_hz.standard_deviation,
                   mode.damping_ratio.value, mode.damping_ratio.standard_deviation,
                   mode.static_gain_kg_m.value, mode.static_gain_kg_m.standard_deviation});
  }
  return table;
}

}  // namespace vibrissa::apps
