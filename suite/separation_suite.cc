#include "suite/separation_suite.h"

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "reproduction/paper_rig.h"
#include "separation/filters/bvrm_separator.h"
#include "separation/filters/fdaf.h"
#include "separation/filters/wiener.h"
#include "separation/identification/identify.h"
#include "separation/stream_methods.h"

namespace vibrissa::suite {

namespace {

using signals::Record;

std::vector<double> by_bvrm(const Scenario& scenario) {
  const Record& record = scenario.vibration_only ? *scenario.vibration_only : scenario.record;
  const auto [fit, held_out] = separation::hold_out_last_third(record);
  const auto identified = separation::identify_bvrm(fit, held_out);
  separation::BvrmSeparator separator(identified.fit.model, record.sampling_rate_hz(),
                                      identified.hold);
  return separation::separate_record(separator, scenario.record);
}

std::vector<double> by_nothing(const Scenario& scenario) {
  const auto measured = scenario.record.channel(signals::channel::base_moment);
  return {measured.begin(), measured.end()};
}

struct Method {
  std::string name;
  std::function<std::vector<double>(const Scenario&)> separate;
};

// The best fixed FIR filter of the same length for the whole record: upper bound of the adaptive
// filters.
std::vector<double> by_wiener(const Scenario& scenario) {
  return separation::wiener_filter(scenario.record, {}).wind_moment;
}

std::vector<Method> make_methods() {
  std::vector<Method> list = {{"nothing removed", by_nothing}, {"bvrm", by_bvrm}};
  for (const auto& method : separation::stream_methods()) {
    list.push_back({method.name, [&method](const Scenario& scenario) {
                      const auto separator = method.make(separation::FdafOptions{});
                      return separation::separate_record(*separator, scenario.record);
                    }});
  }
  list.push_back({"wiener (bound)", by_wiener});
  return list;
}

const std::vector<Method>& methods() {
  static const std::vector<Method> list = make_methods();
  return list;
}

}  // namespace

std::size_t n_suite_methods() {
  return methods().size();
}

ScenarioResult separate_by_all(const Scenario& scenario) {
  ScenarioResult result{scenario.name,
                        scenario.about,
                        scenario.record.sampling_rate_hz(),
                        scenario.record.duration_s(),
                        {}};
  for (const auto& method : methods()) {
    result.methods.push_back(views::score(method.name, method.separate(scenario), scenario.record,
                                          scenario.true_wind_moment_n_m,
                                          reproduction::paper::settling_s));
  }
  return result;
}

report::Table suite_table(const std::vector<ScenarioResult>& results) {
  std::vector<report::Column> columns = views::metric_columns();
  columns.insert(columns.begin(), {report::Column{"scenario", ""}, report::Column{"method", ""}});
  report::Table table(columns);
  for (const auto& result : results) {
    for (const auto& method : result.methods) {
      std::vector<report::Cell> row = views::metric_cells(method);
      row.insert(row.begin(), {result.name, method.name});
      table.add_row(row);
    }
  }
  return table;
}

report::Table sdr_table(const std::vector<ScenarioResult>& results) {
  std::vector<report::Column> columns = {{"SDR [dB]", ""}};
  for (const auto& method : methods()) columns.push_back({method.name, "", 3});
  report::Table table(columns);
  for (const auto& result : results) {
    std::vector<report::Cell> row = {result.name};
    for (const auto& method : result.methods) row.push_back(method.sdr_db);
    table.add_row(row);
  }
  return table;
}

report::Figure suite_figure(const std::vector<ScenarioResult>& results) {
  report::Panel panel;
  panel.x_label = "Scenario (number in the table)";
  panel.y_label = "SDR [dB]";
  panel.x_range = report::Range{0.5, static_cast<double>(results.size()) + 0.5};
  for (std::size_t k = 0; k < methods().size(); ++k) {
    report::Curve curve{.label = methods()[k].name, .style = report::CurveStyle::points};
    for (std::size_t i = 0; i < results.size(); ++i) {
      curve.x.push_back(static_cast<double>(i + 1));
      curve.y.push_back(results[i].methods[k].sdr_db.value_or(std::nan("")));
    }
    panel.curves.push_back(std::move(curve));
  }
  report::Figure figure;
  figure.name = "separation_suite";
  figure.title = "Signal-to-distortion ratio (SDR) of each method in each scenario";
  for (std::size_t i = 0; i < results.size(); ++i) {
    figure.caption += std::to_string(i + 1) + ": " + results[i].name + ", " + results[i].about +
                      (i + 1 < results.size() ? "; " : ".");
  }
  figure.panels = {panel};
  return figure;
}

nlohmann::json suite_json(const std::vector<ScenarioResult>& results) {
  nlohmann::json document{{"scenarios", nlohmann::json::array()}};
  for (const auto& result : results) {
    nlohmann::json entry = views::separation_json(result.methods);
    entry["name"] = result.name;
    entry["about"] = result.about;
    entry["sampling_rate_hz"] = result.sampling_rate_hz;
    entry["duration_s"] = result.duration_s;
    document["scenarios"].push_back(entry);
  }
  return document;
}

}  // namespace vibrissa::suite
