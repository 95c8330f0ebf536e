#include "report/modes/page_scene.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTriangleFilter.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "report/modes/colour_map.h"
#include "report/modes/deformed_mesh.h"
#include "report/text/text.h"

namespace vibrissa::report {
namespace {

double single(const double value) {
  return static_cast<double>(static_cast<float>(value));
}

std::vector<double> coordinates(vtkPoints& points) {
  std::vector<double> list;
  for (vtkIdType i = 0; i < points.GetNumberOfPoints(); ++i)
    for (int k = 0; k < 3; ++k) list.push_back(single(points.GetPoint(i)[k]));
  return list;
}

std::vector<double> components(vtkDataArray& array, const double factor) {
  std::vector<double> list;
  for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i)
    for (int k = 0; k < array.GetNumberOfComponents(); ++k)
      list.push_back(single(factor * array.GetComponent(i, k)));
  return list;
}

/// The point numbers of all cells, one cell after the other.
std::vector<double> corners(vtkCellArray& cells) {
  std::vector<double> list;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < cells.GetNumberOfCells(); ++c) {
    cells.GetCellAtId(c, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      list.push_back(static_cast<double>(ids->GetId(k)));
  }
  return list;
}

std::vector<double> ends_of_lines(vtkPolyData& lines) {
  std::vector<double> list;
  for (const double id : corners(*lines.GetLines()))
    for (int k = 0; k < 3; ++k)
      list.push_back(single(lines.GetPoint(static_cast<vtkIdType>(id))[k]));
  return list;
}

nlohmann::json colours_over(const Range& range) {
  nlohmann::json list = nlohmann::json::array();
  for (const Colour& colour : colour_map(range)) {
    std::array<char, 8> text;
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", colour[0], colour[1], colour[2]);
    list.push_back(text.data());
  }
  return list;
}

}  // namespace

nlohmann::json page_scene(const std::filesystem::path& folder, const ModePicture& picture,
                          PackedNumbers& numbers) {
  const DeformedMesh mesh = read_deformed_mesh(folder / picture.vtu, picture);
  vtkNew<vtkTriangleFilter> filter;
  filter->PassVertsOff();
  filter->PassLinesOff();
  filter->SetInputData(mesh.rest);
  filter->Update();
  vtkPolyData& surface = *filter->GetOutput();
  auto* of_points = surface.GetPointData()->GetArray(colour_array);
  auto* values = of_points ? of_points : surface.GetCellData()->GetArray(colour_array);
  const Range shown = colour_range(mesh.colours);
  return {
      {"name", picture.name},
      {"title", picture.title},
      {"caption", picture.caption},
      {"colour_label", picture.colour_label},
      {"csv", csv_field(picture.colour_label.empty() ? "value" : picture.colour_label)},
      {"points", numbers.add(coordinates(*surface.GetPoints()))},
      {"moves", numbers.add(components(
                    *surface.GetPointData()->GetArray(picture.displacement.c_str()), mesh.scale))},
      {"scale", mesh.scale},
      {"triangles", numbers.add(corners(*surface.GetPolys()))},
      {"values", numbers.add(components(*values, 1.))},
      {"of_cells", of_points == nullptr},
      {"outline", numbers.add(ends_of_lines(*mesh.rest_outline))},
      {"range", {shown.low, shown.high}},
      {"colours", colours_over(mesh.colours)}};
}

}  // namespace vibrissa::report
