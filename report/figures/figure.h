#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/figures/range.h"

namespace vibrissa::report {

enum class CurveStyle { line, points, dashed, band };

/// One line, set of points or band of a panel. Values that are not finite are gaps.
struct Curve {
  std::string label{};  // empty: not in the legend
  CurveStyle style = CurveStyle::line;
  std::vector<double> x{};
  std::vector<double> y{};                // as long as x; empty for a band
  std::vector<double> y_low{}, y_high{};  // as long as x for a band; else empty
  std::optional<std::size_t> colour{};    // index in the palette; default: index in the panel

  bool operator==(const Curve&) const = default;
};

/// One pair of axes. Labels carry the unit: "Frequency [Hz]"; a y label with "°" gets ticks at
/// divisions of a circle. On a logarithmic axis values that are not positive are gaps.
struct Panel {
  std::string title{};
  std::string x_label{}, y_label{};
  bool log_x = false, log_y = false;
  std::optional<Range> x_range{}, y_range{};  // default: the range of the curves
  std::vector<std::string> y_names{};         // labels of y = 1, 2, ... instead of numbers
  std::vector<Curve> curves{};

  bool operator==(const Panel&) const = default;
};

/// Panels from top to bottom. Neighbours with the same x label and nearly the same range of x share
/// their x axis.
struct Figure {
  std::string name{};  // name of the files, without folder and extension
  std::string title{};
  std::string caption{};  // written to the files and reports, not into the picture
  std::vector<Panel> panels{};

  bool operator==(const Figure&) const = default;
};

/// The curve's index in the palette.
inline std::size_t colour_number(const Panel& panel, const std::size_t curve) {
  return panel.curves[curve].colour.value_or(curve);
}

/// Throws UserError, naming panel and curve, for: a name that is not a plain file name, no panels
/// or more than max_panels, lists of unequal length, a range that is reversed or reaches 0 on a
/// logarithmic axis.
void check(const Figure& figure);
inline constexpr std::size_t max_panels = 12;

/// Values that are not finite become null and are read back as NaN. from_json throws UserError for
/// a missing entry or one of a wrong type.
void to_json(nlohmann::json& json, const Figure& figure);
void from_json(const nlohmann::json& json, Figure& figure);

/// One row per point: panel (number from 1), curve, x_name, x, y_name, y, y_low, y_high; fields
/// that do not apply are empty. The long form is needed because curves of one panel need not have
/// the same x.
std::string to_csv(const Figure& figure);

/// Calls check(), then writes FOLDER/figures/NAME.json and FOLDER/figures/NAME.csv.
void write_figure(const std::filesystem::path& folder, const Figure& figure);

/// Throws UserError with the file name and the reason.
Figure read_figure(const std::filesystem::path& file);

}  // namespace vibrissa::report
