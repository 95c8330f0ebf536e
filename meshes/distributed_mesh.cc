#include "meshes/distributed_mesh.h"

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

namespace vibrissa::meshes {

std::unique_ptr<dealii::Triangulation<3>> share_out(dealii::Triangulation<3>& whole,
                                                    MPI_Comm communicator) {
  dealii::GridTools::partition_triangulation(dealii::Utilities::MPI::n_mpi_processes(communicator),
                                             whole);
  auto mesh = std::make_unique<dealii::parallel::fullydistributed::Triangulation<3>>(communicator);
  mesh->create_triangulation(
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation(
          whole, communicator));
  for (const auto id : whole.get_manifold_ids()) {
    if (id != dealii::numbers::flat_manifold_id) mesh->set_manifold(id, whole.get_manifold(id));
  }
  return mesh;
}

}  // namespace vibrissa::meshes
