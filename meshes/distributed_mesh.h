#pragma once

#include <deal.II/grid/tria.h>
#include <mpi.h>

#include <memory>

namespace vibrissa::meshes {

/// Distributes a mesh that every process has created equally: each process keeps its part (METIS,
/// equal numbers of cells) and one layer of cells around it, with regions, boundaries and
/// manifolds. Collective. `whole` receives the numbers of the parts as subdomain ids and is not
/// needed afterwards. Proven by tests/fem/linalg/processes_test.cc.
std::unique_ptr<dealii::Triangulation<3>> share_out(dealii::Triangulation<3>& whole,
                                                    MPI_Comm communicator);

}  // namespace vibrissa::meshes
