#include "report/modes/draw_mode.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkImageShrink3D.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <span>

#include "report/drawing/lettering.h"
#include "report/drawing/picture_file.h"
#include "report/modes/colour_map.h"
#include "report/modes/deformed_mesh.h"
#include "report/modes/mesh_view.h"
#include "report/modes/mode_page.h"

namespace vibrissa::report {
namespace {

/// Of the window relative to the picture, for smooth edges.
constexpr int oversampling = 2;

vtkNew<vtkActor> plain_actor(vtkPolyData& shape, const double grey, const double opacity) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&shape);
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(grey, grey, grey);
  actor->GetProperty()->SetOpacity(opacity);
  actor->GetProperty()->SetLineWidth(static_cast<float>(oversampling));
  return actor;
}

vtkNew<vtkActor> coloured_actor(const DeformedMesh& mesh, vtkLookupTable& colours) {
  vtkNew<vtkPolyDataNormals> normals;  // smooth shading of round sides, sharp edges
  normals->SetInputData(mesh.deformed);
  normals->SetFeatureAngle(40.);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(normals->GetOutputPort());
  mapper->SetLookupTable(&colours);
  mapper->UseLookupTableScalarRangeOn();
  if (mesh.deformed->GetPointData()->HasArray(colour_array))
    mapper->SetScalarModeToUsePointFieldData();
  else
    mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray(colour_array);
  mapper->InterpolateScalarsBeforeMappingOn();
  mapper->SetResolveCoincidentTopologyToPolygonOffset();  // mesh lines stay in front
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.45);
  actor->GetProperty()->SetDiffuse(0.6);
  return actor;
}

void set_camera(vtkRenderer& renderer, const MeshView& view, const Box& box) {
  vtkCamera* camera = renderer.GetActiveCamera();
  const double distance = 2. * (view.width + view.height);
  const Eigen::Vector3d eye = view.centre + distance * view.toward;
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(view.centre.data());
  camera->SetPosition(eye.data());
  camera->SetViewUp(view.up.data());
  const double half_height = 0.5 * std::max(view.height, view.width * box.height / box.width);
  camera->SetParallelScale(1.03 * half_height);
  renderer.ResetCameraClippingRange();
}

void add_mesh(vtkRenderer& renderer, const DeformedMesh& mesh, vtkLookupTable& colours) {
  constexpr double faint = 0.14, clear = 0.6, mesh_lines = 0.25;
  renderer.AddActor(coloured_actor(mesh, colours));
  renderer.AddActor(plain_actor(*mesh.deformed_edges, 0., mesh_lines));
  renderer.AddActor(plain_actor(*mesh.rest, 0.5, faint));
  renderer.AddActor(plain_actor(*mesh.rest_outline, 0.5, clear));
}

vtkNew<vtkLookupTable> lookup_table(const std::span<const Colour> colours, const Range& range) {
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(static_cast<vtkIdType>(colours.size()));
  table->SetTableRange(range.low, range.high);
  for (std::size_t i = 0; i < colours.size(); ++i)
    table->SetTableValue(static_cast<vtkIdType>(i), colours[i][0] / 255., colours[i][1] / 255.,
                         colours[i][2] / 255.);
  return table;
}

Pixels rendered(vtkRenderWindow& window) {
  window.Render();
  vtkNew<vtkWindowToImageFilter> large;
  large->SetInput(&window);
  large->ReadFrontBufferOff();
  large->SetInputBufferTypeToRGB();
  vtkNew<vtkImageShrink3D> smaller;
  smaller->SetInputConnection(large->GetOutputPort());
  smaller->SetShrinkFactors(oversampling, oversampling, 1);
  smaller->AveragingOn();
  smaller->Update();
  vtkImageData& image = *smaller->GetOutput();
  Pixels pixels{.width = image.GetDimensions()[0], .height = image.GetDimensions()[1]};
  for (int y = pixels.height - 1; y >= 0; --y) {
    const auto* const row = static_cast<const std::uint8_t*>(image.GetScalarPointer(0, y, 0));
    pixels.rgb.insert(pixels.rgb.end(), row, row + 3 * pixels.width);
  }
  return pixels;
}

}  // namespace

void prepare_offscreen(vtkRenderWindow& window, const int width, const int height) {
  window.SetOffScreenRendering(1);
  window.SetMultiSamples(0);
  window.SetSize(width, height);
}

void draw_mode(const ModePicture& picture, const std::filesystem::path& run_folder,
               const std::filesystem::path& png) {
  const DeformedMesh mesh = read_deformed_mesh(run_folder / picture.vtu, picture);
  const MeshView view = view_of(mesh);
  const ModePage page = mode_page(picture, mesh, view, text_width);
  const auto colours = colour_map(mesh.colours);
  const auto table = lookup_table(colours, colour_range(mesh.colours));

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1., 1., 1.);
  add_mesh(*renderer, mesh, *table);
  set_camera(*renderer, view, page.mesh);
  vtkNew<vtkRenderWindow> window;
  window->AddRenderer(renderer);
  prepare_offscreen(*window, oversampling * static_cast<int>(page.mesh.width),
                    oversampling * static_cast<int>(page.mesh.height));
  const Pixels pixels = rendered(*window);
  write_picture({.width = page.width,
                 .height = page.height,
                 .paint =
                     [&](Canvas& canvas) {
                       canvas.picture(pixels, {page.mesh.left, page.mesh.bottom,
                                               static_cast<double>(pixels.width),
                                               static_cast<double>(pixels.height)});
                       paint(canvas, page, view, colours);
                     }},
                png);
}

}  // namespace vibrissa::report
