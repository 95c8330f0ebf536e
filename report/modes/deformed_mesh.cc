#include "report/modes/deformed_mesh.h"

#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkExtractEdges.h>
#include <vtkFeatureEdges.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointLocator.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWarpVector.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::report {
namespace {

using signals::UserError;

/// Records an error message of VTK instead of printing it.
class Complaints : public vtkCommand {
 public:
  static Complaints* New() { return new Complaints; }
  void Execute(vtkObject*, unsigned long, void*) override { any = true; }
  bool any = false;
};

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> read_grid_by(const std::filesystem::path& file) {
  vtkNew<Reader> reader;
  vtkNew<Complaints> complaints;
  reader->AddObserver(vtkCommand::ErrorEvent, complaints);
  reader->AddObserver(vtkCommand::WarningEvent, complaints);
  reader->SetReaderErrorObserver(complaints);
  reader->SetParserErrorObserver(complaints);
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, complaints);
  reader->SetFileName(file.c_str());
  if (!reader->CanReadFile(file.c_str()))
    throw UserError(file.string() + ": this is not a VTK file of an unstructured mesh (.vtu)");
  reader->Update();
  if (complaints->any || reader->GetErrorCode() != 0)
    throw UserError(file.string() + ": this " + file.extension().string() +
                    " file is damaged or incomplete");
  if (reader->GetOutput()->GetNumberOfCells() == 0)
    throw UserError(file.string() + ": the mesh has no cells");
  return reader->GetOutput();
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw UserError(file.string() + ": the file does not exist");
  return file.extension() == ".pvtu" ? read_grid_by<vtkXMLPUnstructuredGridReader>(file)
                                     : read_grid_by<vtkXMLUnstructuredGridReader>(file);
}

std::vector<std::string> names_of(vtkDataSetAttributes& data, const int n_components) {
  std::vector<std::string> names;
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    const vtkDataArray* array = data.GetArray(i);
    if (array && array->GetNumberOfComponents() == n_components && data.GetArrayName(i))
      names.emplace_back(data.GetArrayName(i));
  }
  return names;
}

bool has_field(vtkDataSetAttributes& data, const std::string& name, const int n_components) {
  const vtkDataArray* array = data.GetArray(name.c_str());
  return array && array->GetNumberOfComponents() == n_components;
}

double checked(const double value, const std::string& name) {
  if (!std::isfinite(value))
    throw UserError("field '" + name + "' contains values that are not finite");
  return value;
}

/// std::hypot of three numbers may lose a NaN (libstdc++ 12); std::hypot of two does not.
double norm(vtkDataArray& vectors, const vtkIdType i) {
  return std::hypot(std::hypot(vectors.GetComponent(i, 0), vectors.GetComponent(i, 1)),
                    vectors.GetComponent(i, 2));
}

void check_displacement(vtkUnstructuredGrid& grid, const std::string& name) {
  if (!has_field(*grid.GetPointData(), name, 3))
    throw UserError(
        signals::unknown_name("vector field at points", name, names_of(*grid.GetPointData(), 3)));
  vtkDataArray& field = *grid.GetPointData()->GetArray(name.c_str());
  for (vtkIdType i = 0; i < field.GetNumberOfTuples(); ++i) checked(norm(field, i), name);
}

/// Adds the values to be shown to the points or to the cells.
void add_colours(vtkUnstructuredGrid& grid, const ModePicture& picture) {
  const bool magnitude = picture.colour_field.empty();
  const std::string& name = magnitude ? picture.displacement : picture.colour_field;
  vtkDataSetAttributes* data = grid.GetPointData();
  if (!magnitude && !has_field(*data, name, 1)) data = grid.GetCellData();
  if (!magnitude && !has_field(*data, name, 1)) {
    auto known = names_of(*grid.GetPointData(), 1);
    const auto at_cells = names_of(*grid.GetCellData(), 1);
    known.insert(known.end(), at_cells.begin(), at_cells.end());
    throw UserError(signals::unknown_name("scalar field", name, known));
  }
  vtkDataArray& field = *data->GetArray(name.c_str());
  vtkNew<vtkDoubleArray> colours;
  colours->SetName(colour_array);
  for (vtkIdType i = 0; i < field.GetNumberOfTuples(); ++i)
    colours->InsertNextValue(picture.colour_factor *
                             checked(magnitude ? norm(field, i) : field.GetComponent(i, 0), name));
  data->AddArray(colours);
}

/// deal.II repeats the points of neighbouring cells; only merged points show which faces are
/// inside.
vtkSmartPointer<vtkUnstructuredGrid> with_shared_points(vtkUnstructuredGrid& grid) {
  constexpr double part_of_size = 1e-6;  // coordinates in files are single precision
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkPointLocator> locator;
  locator->SetTolerance(part_of_size * grid.GetLength());
  locator->InitPointInsertion(points, grid.GetBounds(), grid.GetNumberOfPoints());
  auto shared = vtkSmartPointer<vtkUnstructuredGrid>::New();
  shared->GetPointData()->CopyAllocate(grid.GetPointData(), grid.GetNumberOfPoints());
  std::vector<vtkIdType> new_number(static_cast<std::size_t>(grid.GetNumberOfPoints()));
  for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
    vtkIdType& number = new_number[static_cast<std::size_t>(i)];
    if (locator->InsertUniquePoint(grid.GetPoint(i), number))
      shared->GetPointData()->CopyData(grid.GetPointData(), i, number);
  }
  shared->SetPoints(points);
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
    grid.GetCellPoints(c, corners);
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      corners->SetId(k, new_number[static_cast<std::size_t>(corners->GetId(k))]);
    shared->InsertNextCell(grid.GetCellType(c), corners);
  }
  shared->GetCellData()->ShallowCopy(grid.GetCellData());
  return shared;
}

vtkSmartPointer<vtkPolyData> warped(vtkPolyData& shape, const std::string& field,
                                    const double scale) {
  vtkNew<vtkWarpVector> warp;
  warp->SetInputData(&shape);
  warp->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, field.c_str());
  warp->SetScaleFactor(scale);
  warp->Update();
  return warp->GetPolyDataOutput();
}

vtkSmartPointer<vtkPolyData> surface_of(vtkUnstructuredGrid& grid) {
  constexpr int subdivisions_of_curved_cells = 1;
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(&grid);
  surface->SetNonlinearSubdivisionLevel(subdivisions_of_curved_cells);
  surface->Update();
  return surface->GetOutput();
}

vtkSmartPointer<vtkPolyData> edges_of(vtkUnstructuredGrid& grid) {
  vtkNew<vtkExtractEdges> edges;
  edges->SetInputData(&grid);
  edges->Update();
  return edges->GetOutput();
}

vtkSmartPointer<vtkPolyData> outline_of(vtkPolyData& surface) {
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(&surface);
  edges->SetFeatureAngle(40.);
  edges->BoundaryEdgesOff();
  edges->NonManifoldEdgesOff();
  edges->ColoringOff();
  edges->Update();
  return edges->GetOutput();
}

/// 1, 2 or 5 times a power of ten that displaces the mesh by up to 15 % of its size; 1 without
/// displacement.
double visible_scale(vtkUnstructuredGrid& grid, const std::string& displacement) {
  vtkDataArray& field = *grid.GetPointData()->GetArray(displacement.c_str());
  double largest = 0.;
  for (vtkIdType i = 0; i < field.GetNumberOfTuples(); ++i)
    largest = std::max(largest, norm(field, i));
  if (largest == 0.) return 1.;
  const double most = 0.15 * grid.GetLength() / largest;
  const double power = std::pow(10., std::floor(std::log10(most)));
  return most >= 5. * power ? 5. * power : most >= 2. * power ? 2. * power : power;
}

DeformedMesh deformed_mesh(vtkUnstructuredGrid& grid, const ModePicture& picture) {
  check_displacement(grid, picture.displacement);
  add_colours(grid, picture);
  const auto shared = with_shared_points(grid);
  DeformedMesh mesh;
  mesh.scale = picture.scale.value_or(visible_scale(*shared, picture.displacement));
  mesh.rest = surface_of(*shared);
  mesh.deformed = warped(*mesh.rest, picture.displacement, mesh.scale);
  mesh.rest_outline = outline_of(*mesh.rest);
  mesh.deformed_edges = warped(*edges_of(*shared), picture.displacement, mesh.scale);
  auto* at_points = mesh.rest->GetPointData()->GetArray(colour_array);
  auto* colours = at_points ? at_points : mesh.rest->GetCellData()->GetArray(colour_array);
  mesh.colours = {colours->GetRange()[0], colours->GetRange()[1]};
  return mesh;
}

}  // namespace

DeformedMesh read_deformed_mesh(const std::filesystem::path& vtu, const ModePicture& picture) {
  const auto grid = read_grid(vtu);
  try {
    return deformed_mesh(*grid, picture);
  } catch (const UserError& error) {
    throw UserError(vtu.string() + ": " + error.what());
  }
}

}  // namespace vibrissa::report
