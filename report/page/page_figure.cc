#include "report/page/page_figure.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/figures/table.h"
#include "report/text/text.h"

namespace vibrissa::report {
namespace {

std::string range_text(const std::vector<double>& low, const std::vector<double>& high) {
  double least = INFINITY, most = -INFINITY;
  for (const double value : low)
    if (std::isfinite(value)) least = std::min(least, value);
  for (const double value : high)
    if (std::isfinite(value)) most = std::max(most, value);
  return least > most ? "-" : significant(least, 4) + " to " + significant(most, 4);
}

}  // namespace

nlohmann::json page_figure(const Figure& figure, PackedNumbers& numbers) {
  nlohmann::json json = figure;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const Curve& curve = panel.curves[c];
      nlohmann::json& entry = json["panels"][p]["curves"][c];
      entry["colour"] = colour_number(panel, c);
      entry["csv"] = {csv_field(curve.label), csv_field(panel.x_label), csv_field(panel.y_label)};
      entry["x"] = numbers.add(curve.x);
      if (curve.style == CurveStyle::band) {
        entry["y_low"] = numbers.add(curve.y_low);
        entry["y_high"] = numbers.add(curve.y_high);
      } else {
        entry["y"] = numbers.add(curve.y);
      }
    }
  }
  return json;
}

std::string figure_in_words(const Figure& figure) {
  Table table({{"panel", ""},
               {"curve", ""},
               {"points", ""},
               {"x axis", ""},
               {"range of x", ""},
               {"y axis", ""},
               {"range of y", ""}});
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    for (const Curve& curve : panel.curves) {
      const bool band = curve.style == CurveStyle::band;
      table.add_row({panel.title.empty() ? std::to_string(p + 1) : panel.title,
                     curve.label.empty() ? panel.y_label : curve.label, curve.x.size(),
                     panel.x_label, range_text(curve.x, curve.x), panel.y_label,
                     band ? range_text(curve.y_low, curve.y_high) : range_text(curve.y, curve.y)});
    }
  }
  return table.to_html("Curves of the figure: " + figure.title);
}

}  // namespace vibrissa::report
