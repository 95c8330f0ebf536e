#include "fem/factors/sparse_factors.h"

#include "fem/factors/mumps_factors.h"
#include "fem/factors/supernodal_factors.h"

namespace vibrissa::fem {

void throw_indefinite() {
  throw IndefiniteMatrix(
      "the stiffness matrix is not positive definite: a part of the mesh is not connected to the "
      "clamp, or a material is unstable; check regions, boundaries and moduli");
}

std::unique_ptr<SparseFactors> make_factors(const Matrix& matrix) {
  if (dealii::Utilities::MPI::n_mpi_processes(matrix.get_mpi_communicator()) > 1)
    return std::make_unique<MumpsFactors>(matrix);
  return std::make_unique<SupernodalFactors>(matrix);
}

}  // namespace vibrissa::fem
