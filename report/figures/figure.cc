#include "report/figures/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/text/file_name.h"
#include "report/text/json_file.h"
#include "report/text/text.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/system/output_file.h"

namespace vibrissa::report {
namespace {

using nlohmann::json;
using signals::UserError;

constexpr std::array<std::pair<CurveStyle, const char*>, 4> style_names = {
    {{CurveStyle::line, "line"},
     {CurveStyle::points, "points"},
     {CurveStyle::dashed, "dashed"},
     {CurveStyle::band, "band"}}};

std::string name_of(const CurveStyle style) {
  return std::find_if(style_names.begin(), style_names.end(),
                      [&](const auto& entry) { return entry.first == style; })
      ->second;
}

CurveStyle style_named(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [style, known_name] : style_names) {
    if (name == known_name) return style;
    known.push_back(known_name);
  }
  throw UserError(signals::unknown_name("curve style", name, known));
}

std::vector<double> numbers(const json& object, const std::string& key) {
  const auto list = object.find(key);
  if (list == object.end()) return {};
  if (!list->is_array()) throw UserError("'" + key + "' must be a list of numbers");
  std::vector<double> values;
  values.reserve(list->size());
  for (const json& item : *list) {
    if (!item.is_number() && !item.is_null())
      throw UserError("'" + key + "' holds " + item.dump().substr(0, 40) +
                      ", which is not a number");
    values.push_back(item.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                    : item.get<double>());
  }
  return values;
}

json curve_json(const Curve& curve) {
  json object = {{"label", curve.label}, {"style", name_of(curve.style)}, {"x", curve.x}};
  if (curve.style == CurveStyle::band) {
    object["y_low"] = curve.y_low;
    object["y_high"] = curve.y_high;
  } else {
    object["y"] = curve.y;
  }
  if (curve.colour) object["colour"] = *curve.colour;
  return object;
}

Curve curve_from(const json& object) {
  if (!object.is_object()) throw UserError("'curves' must hold objects");
  Curve curve;
  curve.label = given_or<std::string>(object, "label", "");
  curve.style = style_named(given_or<std::string>(object, "style", "line"));
  curve.x = numbers(object, "x");
  curve.y = numbers(object, "y");
  curve.y_low = numbers(object, "y_low");
  curve.y_high = numbers(object, "y_high");
  if (const auto colour = object.find("colour"); colour != object.end()) {
    if (!colour->is_number_unsigned()) throw UserError("'colour' must be 0, 1, 2, ...");
    curve.colour = colour->get<std::size_t>();
  }
  return curve;
}

json panel_json(const Panel& panel) {
  json object = {{"title", panel.title}, {"x_label", panel.x_label}, {"y_label", panel.y_label},
                 {"log_x", panel.log_x}, {"log_y", panel.log_y},     {"curves", json::array()}};
  if (panel.x_range) object["x_range"] = {panel.x_range->low, panel.x_range->high};
  if (panel.y_range) object["y_range"] = {panel.y_range->low, panel.y_range->high};
  if (!panel.y_names.empty()) object["y_names"] = panel.y_names;
  for (const Curve& curve : panel.curves) object["curves"].push_back(curve_json(curve));
  return object;
}

std::optional<Range> range_from(const json& object, const std::string& key) {
  if (!object.contains(key)) return {};
  const auto ends = numbers(object, key);
  if (ends.size() != 2) throw UserError("'" + key + "' must be two numbers, [low, high]");
  return Range{ends[0], ends[1]};
}

Panel panel_from(const json& object) {
  if (!object.is_object()) throw UserError("'panels' must hold objects");
  Panel panel;
  panel.title = given_or<std::string>(object, "title", "");
  panel.x_label = required<std::string>(object, "x_label");
  panel.y_label = required<std::string>(object, "y_label");
  panel.log_x = given_or(object, "log_x", false);
  panel.log_y = given_or(object, "log_y", false);
  panel.x_range = range_from(object, "x_range");
  panel.y_range = range_from(object, "y_range");
  panel.y_names = given_or<std::vector<std::string>>(object, "y_names", {});
  for (const json& curve : required<std::vector<json>>(object, "curves"))
    panel.curves.push_back(curve_from(curve));
  return panel;
}

void check_range(const std::optional<Range>& range, const bool log, const std::string& where) {
  if (!range) return;
  if (!std::isfinite(range->low) || !std::isfinite(range->high) || range->low >= range->high)
    throw UserError(where + " must be two finite numbers, the lower one first");
  if (log && range->low <= 0.) throw UserError(where + " must be positive on a logarithmic axis");
}

void check_curve(const Curve& curve, const std::string& where) {
  const bool band = curve.style == CurveStyle::band;
  const std::size_t n_band = band ? curve.x.size() : 0, n_y = band ? 0 : curve.x.size();
  if (curve.y.size() != n_y || curve.y_low.size() != n_band || curve.y_high.size() != n_band)
    throw UserError(where + " needs " + (band ? "y_low and y_high, without y," : "y alone") +
                    " as long as x (" + std::to_string(curve.x.size()) + " values)");
}

void add_csv_lines(std::string& csv, const std::size_t number, const Panel& panel,
                   const Curve& curve) {
  const std::string head =
      std::to_string(number) + ',' + csv_field(curve.label) + ',' + csv_field(panel.x_label) + ',';
  const std::string middle = ',' + csv_field(panel.y_label) + ',';
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    csv += head + signals::to_text(curve.x[i]) + middle;
    csv += curve.style == CurveStyle::band
               ? ',' + signals::to_text(curve.y_low[i]) + ',' + signals::to_text(curve.y_high[i])
               : signals::to_text(curve.y[i]) + ",,";
    csv += '\n';
  }
}

}  // namespace

void check(const Figure& figure) {
  check_file_name("figure", figure.name);
  const std::string name = "figure '" + figure.name + "'";
  if (figure.panels.empty() || figure.panels.size() > max_panels)
    throw UserError(name + " has " + std::to_string(figure.panels.size()) + " panels; 1 to " +
                    std::to_string(max_panels) + " can be drawn");
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    const std::string where = name + ", panel " + std::to_string(p + 1);
    check_range(panel.x_range, panel.log_x, where + ": x_range");
    check_range(panel.y_range, panel.log_y, where + ": y_range");
    if (panel.log_y && !panel.y_names.empty())
      throw UserError(where + ": y_names are not allowed on a logarithmic axis");
    for (std::size_t c = 0; c < panel.curves.size(); ++c)
      check_curve(panel.curves[c], where + ", curve " + std::to_string(c + 1) + " ('" +
                                       panel.curves[c].label + "')");
  }
}

void to_json(json& json, const Figure& figure) {
  json = {{"name", figure.name}, {"title", figure.title}, {"caption", figure.caption}};
  json["panels"] = nlohmann::json::array();
  for (const Panel& panel : figure.panels) json["panels"].push_back(panel_json(panel));
}

void from_json(const json& json, Figure& figure) {
  figure.name = required<std::string>(json, "name");
  figure.title = given_or<std::string>(json, "title", "");
  figure.caption = given_or<std::string>(json, "caption", "");
  figure.panels.clear();
  for (const auto& panel : required<std::vector<nlohmann::json>>(json, "panels"))
    figure.panels.push_back(panel_from(panel));
}

std::string to_csv(const Figure& figure) {
  std::string csv = "panel,curve,x_name,x,y_name,y,y_low,y_high\n";
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    for (const Curve& curve : figure.panels[p].curves)
      add_csv_lines(csv, p + 1, figure.panels[p], curve);
  return csv;
}

void write_figure(const std::filesystem::path& folder, const Figure& figure) {
  check(figure);
  const auto stem = folder / "figures" / figure.name;
  make_folder(stem.parent_path());
  write_json(stem.string() + ".json", figure);
  signals::write_file(stem.string() + ".csv", [&](std::ostream& out) { out << to_csv(figure); });
}

Figure read_figure(const std::filesystem::path& file) {
  const json json = read_json(file);
  try {
    auto figure = json.get<Figure>();
    check(figure);
    return figure;
  } catch (const UserError& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

}  // namespace vibrissa::report
