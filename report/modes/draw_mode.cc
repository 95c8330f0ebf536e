#include "report/modes/draw_mode.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>

#include "report/drawing/lettering.h"
#include "report/drawing/picture_file.h"
#include "report/figures/colour_map.h"
#include "report/modes/deformed_mesh.h"
#include "report/modes/mesh_view.h"
#include "report/modes/mode_page.h"

namespace vibrissa::report {
namespace {

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

}  // namespace

void draw_mode(const ModePicture& picture, const std::filesystem::path& run_folder,
               const std::filesystem::path& png) {
  const DeformedMesh mesh = read_deformed_mesh(run_folder / picture.vtu, picture);
  const MeshView view = view_of(mesh);
  const ModePage page = mode_page(picture, mesh, view, text_width, oversampling);
  const auto colours = colour_map(mesh.colours);

  vtkNew<vtkRenderer> page_renderer, mesh_renderer;
  for (vtkRenderer* renderer : {page_renderer.Get(), mesh_renderer.Get()})
    renderer->SetBackground(1., 1., 1.);
  vtkNew<ModePagePainter> painter;
  painter->show(page, view, colours);
  vtkNew<vtkContextActor> context;
  context->GetScene()->AddItem(painter);
  context->GetScene()->SetRenderer(page_renderer);
  page_renderer->AddActor(context);
  mesh_renderer->SetViewport(page.mesh.left / page.width, page.mesh.bottom / page.height,
                             page.mesh.right() / page.width, page.mesh.top() / page.height);
  add_mesh(*mesh_renderer, mesh, *colours);
  set_camera(*mesh_renderer, view, page.mesh);

  vtkNew<vtkRenderWindow> window;
  window->AddRenderer(page_renderer);
  window->AddRenderer(mesh_renderer);
  prepare_offscreen(*window, page.width, page.height);
  write_png(*window, png);
}

}  // namespace vibrissa::report
