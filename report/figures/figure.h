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

/// One line, cloud of points or band of a panel. What is not finite is a gap.
struct Curve {
  std::string label{};  // empty: not in the legend
  CurveStyle style = CurveStyle::line;
  std::vector<double> x{};
  std::vector<double> y{};                // as long as x; empty for a band
  std::vector<double> y_low{}, y_high{};  // as long as x for a band; else empty
  std::optional<std::size_t> colour{};    // number in the palette; else the place in the panel

  bool operator==(const Curve&) const = default;
};

/// One pair of axes. Labels carry the unit: "Frequency [Hz]"; a y label with "°" gets ticks at
/// divisions of a circle. On a logarithmic axis values that are not positive are gaps.
struct Panel {
  std::string title{};
  std::string x_label{}, y_label{};
  bool log_x = false, log_y = false;
  std::optional<Range> x_range{}, y_range{};  // else what the curves need
  std::vector<std::string> y_names{};         // of y = 1, 2, ..., in place of numbers
  std::vector<Curve> curves{};

  bool operator==(const Panel&) const = default;
};

/// Panels from top to bottom. Neighbours with the same x label and nearly the same range of x share
/// their x axis.
struct Figure {
  std::string name{};  // of the files, without folder and extension
  std::string title{};
  std::string caption{};  // goes with the files and into reports, not into the picture
  std::vector<Panel> panels{};

  bool operator==(const Figure&) const = default;
};

/// The curve's number in the palette.
inline std::size_t colour_number(const Panel& panel, const std::size_t curve) {
  return panel.curves[curve].colour.value_or(curve);
}

/// Throws UserError, naming panel and curve, for: a name that is no plain file name, no panels or
/// more than max_panels, lists of unequal length, a range that is reversed or reaches 0 on a
/// logarithmic axis.
void check(const Figure& figure);
inline constexpr std::size_t max_panels = 12;

/// What is not finite becomes null and comes back as NaN. from_json throws UserError for a missing
/// or mistyped entry.
void to_json(nlohmann::json& json, const Figure& figure);
void from_json(const nlohmann::json& json, Figure& figure);

/// One line a point: panel (number from 1), curve, x_name, x, y_name, y, y_low, y_high; what does
/// not apply is empty. Long form, because curves of one panel need not share their x.
std::string to_csv(const Figure& figure);

/// Checks, then writes FOLDER/figures/NAME.json and FOLDER/figures/NAME.csv.
void write_figure(const std::filesystem::path& folder, const Figure& figure);

/// Throws UserError with the file in front of the reason.
Figure read_figure(const std::filesystem::path& file);

}  // namespace vibrissa::report
