#include "fem/sensor/vtk_output.h"

#include <deal.II/base/numbers.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/data_out.h>

#include <cmath>
#include <ostream>

#include "fem/linalg/processes.h"
#include "meshes/regions.h"
#include "signals/system/output_file.h"

namespace vibrissa::fem {

namespace {

struct CellStress {
  dealii::Vector<double> von_mises, pressure, region;
};

CellStress mean_cell_stress(const Sensor& sensor, const Vector& displacement) {
  const auto& space = sensor.space();
  const auto materials = sensor.parameters().materials.by_region();
  const unsigned int n_cells = sensor.mesh().n_active_cells();
  CellStress stress{dealii::Vector<double>(n_cells), dealii::Vector<double>(n_cells),
                    dealii::Vector<double>(n_cells)};
  const dealii::QGauss<3> quadrature(3);
  dealii::FEValues<3> values(space.mapping(), space.dofs().get_fe(), quadrature,
                             dealii::update_gradients | dealii::update_JxW_values);
  const dealii::FEValuesExtractors::Vector all(0);
  std::vector<dealii::SymmetricTensor<2, 3>> strains(quadrature.size());
  const Vector ghosted = space.make_ghosted(displacement);
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    values[all].get_function_symmetric_gradients(ghosted, strains);
    dealii::SymmetricTensor<2, 3> mean;
    double volume = 0.;
    for (unsigned int q = 0; q < quadrature.size(); ++q) {
      mean += values.JxW(q) * strains[q];
      volume += values.JxW(q);
    }
    mean /= volume;
    const auto& material = materials.at(meshes::region_name(cell->material_id()));
    const auto deviatoric = 2. * material.shear_modulus_at_rest() * dealii::deviator(mean);
    const unsigned int i = cell->active_cell_index();
    stress.von_mises[i] = std::sqrt(1.5) * deviatoric.norm();
    stress.pressure[i] = -material.volumetric.pressure(dealii::trace(mean));
    stress.region[i] = cell->material_id();
  }
  return stress;
}

std::filesystem::path write_parts(const std::filesystem::path& file, const dealii::DataOut<3>& out,
                                  MPI_Comm communicator) {
  const auto write_vtu = [&](std::ostream& stream) { out.write_vtu(stream); };
  const unsigned int n = dealii::Utilities::MPI::n_mpi_processes(communicator);
  if (n == 1) {
    signals::write_file(file, write_vtu);
    return file;
  }
  const unsigned int number = dealii::Utilities::MPI::this_mpi_process(communicator);
  std::vector<std::string> parts;
  for (unsigned int k = 0; k < n; ++k)
    parts.push_back(file.stem().string() + "." + std::to_string(k) + ".vtu");
  signals::write_file(file.parent_path() / parts[number], write_vtu);
  MPI_Barrier(communicator);
  auto list = file;
  list.replace_extension(".pvtu");
  if (number == 0)
    signals::write_file(list, [&](std::ostream& stream) { out.write_pvtu_record(stream, parts); });
  return list;
}

}  // namespace

std::filesystem::path write_vtu(const std::filesystem::path& file, const Sensor& sensor,
                                const Vector& displacement, const double time_s) {
  using Interpretation = dealii::DataComponentInterpretation::DataComponentInterpretation;
  const auto& space = sensor.space();
  const CellStress stress = mean_cell_stress(sensor, displacement);
  const Vector ghosted = space.make_ghosted(displacement);
  dealii::DataOut<3> out;
  dealii::DataOutBase::VtkFlags flags(time_s);
  flags.write_higher_order_cells = true;
  out.set_flags(flags);
  out.add_data_vector(space.dofs(), ghosted, std::vector<std::string>(3, "displacement_m"),
                      std::vector<Interpretation>(
                          3, dealii::DataComponentInterpretation::component_is_part_of_vector));
  out.attach_dof_handler(space.dofs());
  out.add_data_vector(stress.von_mises, "von_mises_stress_Pa");
  out.add_data_vector(stress.pressure, "pressure_Pa");
  out.add_data_vector(stress.region, "region");
  out.build_patches(space.mapping(), SolidSpace::degree, dealii::DataOut<3>::curved_inner_cells);
  return write_parts(file, out, space.dofs().get_communicator());
}

void write_pvd(const std::filesystem::path& file, const std::span<const double> times_s,
               const std::span<const std::string> vtu_names) {
  if (!is_first_process()) return;
  std::vector<std::pair<double, std::string>> list;
  for (std::size_t i = 0; i < vtu_names.size(); ++i) list.emplace_back(times_s[i], vtu_names[i]);
  signals::write_file(
      file, [&](std::ostream& stream) { dealii::DataOutBase::write_pvd_record(stream, list); });
}

std::filesystem::path write_mode_animation(const std::filesystem::path& folder,
                                           const Sensor& sensor, const std::size_t number,
                                           const unsigned int n_frames) {
  const auto& mode = sensor.modes()[number - 1];
  const double amplitude =
      0.1 * sensor.parameters().geometry.tip_height() / mode.shape.linfty_norm();
  const std::string stem = "mode_" + std::to_string(number);
  std::vector<double> times;
  std::vector<std::string> names;
  for (unsigned int i = 0; i < n_frames; ++i) {
    const double turn = static_cast<double>(i) / n_frames;
    Vector frame(mode.shape);
    frame *= amplitude * std::cos(2. * dealii::numbers::PI * turn);
    times.push_back(turn / mode.frequency_hz);
    const auto written =
        write_vtu(folder / (stem + "_" + std::to_string(i) + ".vtu"), sensor, frame, times.back());
    names.push_back(written.filename().string());
  }
  const auto file = folder / (stem + ".pvd");
  write_pvd(file, times, names);
  return file;
}

}  // namespace vibrissa::fem
