#pragma once

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkLagrangeHexahedron.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

namespace vibrissa::report::testing {

using Point = std::array<double, 3>;
using Field = std::function<Point(const Point&)>;

/// A column of n_cells quadratic Lagrange hexahedra, width x width x height, from z = 0 upward,
/// each with points of its own as deal.II writes them, and the vector field "displacement_m".
inline vtkSmartPointer<vtkUnstructuredGrid> column_mesh(const int n_cells, const double width,
                                                        const double height, const Field& field) {
  constexpr std::array<int, 3> order = {2, 2, 2};
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> displacement;
  displacement->SetName("displacement_m");
  displacement->SetNumberOfComponents(3);
  for (int c = 0; c < n_cells; ++c) {
    std::vector<vtkIdType> ids(27);
    for (int i = 0; i <= 2; ++i)
      for (int j = 0; j <= 2; ++j)
        for (int k = 0; k <= 2; ++k) {
          const Point x = {width * (i / 2. - 0.5), width * (j / 2. - 0.5),
                           height * (c + k / 2.) / n_cells};
          const auto place = vtkLagrangeHexahedron::PointIndexFromIJK(i, j, k, order.data());
          ids[static_cast<std::size_t>(place)] = points->InsertNextPoint(x.data());
          displacement->InsertNextTuple(field(x).data());
        }
    grid->InsertNextCell(VTK_LAGRANGE_HEXAHEDRON, 27, ids.data());
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(displacement);
  return grid;
}

inline void write_grid(const std::filesystem::path& file, vtkUnstructuredGrid& grid) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;  // appended, compressed by zlib
  writer->SetInputData(&grid);
  writer->SetFileName(file.c_str());
  writer->Write();
}

}  // namespace vibrissa::report::testing
