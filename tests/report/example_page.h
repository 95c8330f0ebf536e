#pragma once

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/modes/page_scene.h"
#include "report/page/page.h"
#include "report/text/json_file.h"
#include "tests/report/meshes.h"

namespace vibrissa::report::testing {

/// A hostile record name.
inline constexpr const char* hostile_name =
    R"(run </script><script>alert("x")</script> & 'co' {{style}} <!-- <img src=x onerror=alert(1)>)";

/// A response with its band, a cloud of points, gaps and both axes logarithmic.
inline Figure example_response() {
  Curve band{.label = "measured, \u00b1 2 deviations", .style = CurveStyle::band};
  Curve before{.label = "simulation"}, after{.label = "updated", .style = CurveStyle::dashed};
  Curve points{.label = "other record", .style = CurveStyle::points};
  for (int i = 0; i < 200; ++i) {
    const double f = 1. * std::pow(200., i / 199.), r = f / 37.;
    const double gain = 1e-5 / std::hypot(1. - r * r, 0.1 * r);
    band.x.push_back(f);
    band.y_low.push_back(0.9 * gain);
    band.y_high.push_back(1.1 * gain);
    before.x.push_back(f);
    before.y.push_back(i == 50 ? std::nan("") : 0.8 * gain);
    after.x.push_back(f);
    after.y.push_back(gain);
    if (i % 7 == 0) {
      points.x.push_back(1.01 * f);
      points.y.push_back(1.05 * gain);
    }
  }
  const Panel size{.title = "Response of a record",
                   .x_label = "Frequency [Hz]",
                   .y_label = "|M / a| [N m s\u00b2/m]",
                   .log_x = true,
                   .log_y = true,
                   .curves = {band, before, after, points}};
  Panel phase = size;
  phase.title.clear();
  phase.y_label = "Phase [\u00b0]";
  phase.log_y = false;
  phase.curves = {before};
  for (double& y : phase.curves[0].y) y = std::atan(1e5 * y) * -90.;
  return {.name = "response",
          .title = "Response before and after",
          .caption = "At the lines that the drive excites.",
          .panels = {size, phase}};
}

/// n samples at 1 kHz.
inline Figure example_trace(const std::size_t n, const std::string& record) {
  Curve curve{.label = record};
  for (std::size_t i = 0; i < n; ++i) {
    curve.x.push_back(static_cast<double>(i) / 1000.);
    curve.y.push_back(std::sin(0.03 * double(i)) + 1e-3 * double(i % 17) + 1. / 3.);
  }
  curve.y[3] = -std::nan("");
  curve.y[4] = 1e-7;
  return {.name = "trace",
          .title = "Trace",
          .caption = "A long record.",
          .panels = {{.title = "Record " + record,
                      .x_label = "Time [s]",
                      .y_label = "Base moment, \"measured\" [\u00b5N m]",
                      .curves = {curve}}}};
}

/// Doubles that are difficult to print exactly.
inline Figure example_numbers() {
  Curve curve{.style = CurveStyle::points};
  for (int power = -30; power <= 30; ++power)
    for (const double factor : {1., 2.5, 1. / 3., -1.2345678901234567})
      curve.y.push_back(factor * std::pow(10., power));
  for (const double y :
       {0., -0., 5e-324, 1.7976931348623157e308, 123456789012345680., 9007199254740993.})
    curve.y.push_back(y);
  for (std::size_t i = 0; i < curve.y.size(); ++i) curve.x.push_back(0.1 * static_cast<double>(i));
  return {.name = "numbers",
          .title = "Numbers of all sizes",
          .panels = {{.x_label = "Place", .y_label = "Number", .curves = {curve}}}};
}

/// Names instead of numbers.
inline Figure example_ranking() {
  return {
      .name = "ranking",
      .title = "Ranking",
      .caption = "Probability of each answer.",
      .panels = {
          {.x_label = "Probability",
           .y_label = "Answer",
           .x_range = Range{0., 1.},
           .y_names = {"unlisted", "damping", "joint_friction + stiffness"},
           .curves = {{.style = CurveStyle::points, .x = {0.9, 0.08, 0.02}, .y = {3., 2., 1.}}}}}};
}

/// A page with all kinds of content, in a folder with its run.json and meshes.
inline Page example_page(const std::filesystem::path& folder, const std::size_t n_samples = 20000) {
  std::filesystem::create_directories(folder);
  write_json(folder / "run.json",
             {{"program", "vibrissa"},
              {"version", "1.2.3"},
              {"revision", "abc"},
              {"command_line", {"vibrissa", "diagnose", "--real", hostile_name}},
              {"started_utc", "2001-02-03T04:05:06Z"},
              {"seed", 7}});
  const auto bending = [](const int half_waves) {
    return [half_waves](const Point& x) {
      return Point{0.1 * std::sin(1.5 * half_waves * x[2]), 0., 0.};
    };
  };
  constexpr int n_cells = 12;
  std::vector<ModePicture> scenes;
  for (const int k : {1, 2}) {
    const std::string name = "mode_" + std::to_string(k);
    const auto grid = column_mesh(n_cells, 0.1, 1., bending(k));
    vtkNew<vtkDoubleArray> stress;
    stress->SetName("stress_Pa");
    for (int c = 0; c < n_cells; ++c) stress->InsertNextValue(1e3 * (n_cells / 2 - c));
    grid->GetCellData()->AddArray(stress);
    write_grid(folder / (name + ".vtu"), *grid);
    scenes.push_back({.name = name,
                      .title = "Mode " + std::to_string(k) + ", " + hostile_name,
                      .caption = "The size has no meaning.",
                      .vtu = name + ".vtu",
                      .displacement = "displacement_m",
                      .colour_label = "Displacement, relative"});
  }
  scenes.back().colour_field = "stress_Pa";
  scenes.back().colour_label = "Stress [kPa]";
  scenes.back().colour_factor = 1e-3;
  Table table({{"record", ""}, {"error", "%", 3}, {"note, \"quoted\"", ""}});
  table.add_row({hostile_name, 1. / 3., "-"});
  table.add_row({"plain", 12., {}});
  for (Figure figure : {example_response(), example_trace(n_samples, hostile_name),
                        example_numbers(), example_ranking()})
    write_figure(folder, figure);
  return {.title = std::string("Example ") + hostile_name,
          .headline = "Joint friction explains the gap",
          .verdict = {std::string("Of ") + hostile_name},
          .numbers = {{"Gap closed", "97 %", "95 %: 95 to 98 %"},
                      {"Error left", "2.5 %", "noise 2.4 %"}},
          .sections = {{.heading = "Where",
                        .text = {"Near the first mode."},
                        .tables = {{"records", "Records", table}},
                        .figures = {example_response()}},
                       {.heading = std::string("Traces of ") + hostile_name,
                        .figures = {example_trace(n_samples, hostile_name), example_numbers(),
                                    example_ranking()}},
                       {.heading = "Shape", .scenes = scenes}}};
}

}  // namespace vibrissa::report::testing
