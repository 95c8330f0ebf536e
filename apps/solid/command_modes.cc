#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command_line/command.h"
#include "apps/solid/jobs/case_options.h"
#include "fem/linalg/solver_session.h"
#include "signals/base/error.h"
#include "views/run/mode_table.h"

namespace vibrissa::apps {

namespace {

struct ModesOptions {
  CommonOptions common;
  CaseOptions chosen;
  bool convergence = true;
  std::optional<unsigned int> first_resolution;
};

nlohmann::json convergence_json(const std::vector<views::ConvergenceLevel>& levels) {
  nlohmann::json document{{"levels", nlohmann::json::array()}};
  for (const auto& level : levels) {
    document["levels"].push_back({{"resolution", level.resolution},
                                  {"cells", level.cells},
                                  {"dofs", level.dofs},
                                  {"first_frequency_hz", level.frequency_hz}});
  }
  const double last = levels[levels.size() - 1].frequency_hz;
  document["last_change_percent"] =
      100. * std::abs(levels[levels.size() - 2].frequency_hz - last) / last;
  const auto order = views::observed_order(levels);
  document["observed_order"] = order ? nlohmann::json(order->order) : nlohmann::json();
  document["extrapolated_hz"] = order ? nlohmann::json(order->limit_hz) : nlohmann::json();
  return document;
}

void print_convergence(const nlohmann::json& document) {
  report::Table table(
      {{"resolution", ""}, {"cells", ""}, {"unknowns", ""}, {"first mode", "Hz", 6}});
  for (const auto& level : document["levels"]) {
    table.add_row({level["resolution"].get<int>(), level["cells"].get<int>(),
                   level["dofs"].get<int>(), level["first_frequency_hz"].get<double>()});
  }
  std::cout << "\nRefinement of the mesh:\n" << table.to_text();
  std::cout << "last change " << document["last_change_percent"].get<double>() << " %";
  if (document["observed_order"].is_null()) {
    std::cout << "; no observed order (the changes do not decrease steadily)\n";
  } else {
    std::cout << "; observed order " << document["observed_order"].get<double>()
              << "; extrapolated " << document["extrapolated_hz"].get<double>() << " Hz\n";
  }
}

void say_gravity(const std::array<double, 3>& gravity_m_s2) {
  if (gravity_m_s2 == std::array<double, 3>{}) return;
  std::cout << "Vibration about the equilibrium under gravity of " << gravity_m_s2[0] << ", "
            << gravity_m_s2[1] << ", " << gravity_m_s2[2] << " m/s^2 (x, y, z)\n";
}

void show_modes(const ModesOptions& options) {
  sensor_case::Case parameters = options.chosen.load().read();
  parameters.sensor.gravity_m_s2 = parameters.transient.gravity_m_s2;
  const bool has_mesh_file = parameters.sensor.model.mesh_file.has_value();
  if (options.first_resolution && (!options.convergence || has_mesh_file))
    throw signals::UserError(std::string("--refine-from changes nothing, because ") +
                             (has_mesh_file ? "the case has a Mesh file, which is not refined"
                                            : "--no-convergence leaves the refinement out") +
                             "; leave it out");
  const fem::SolverSession session;
  const fem::Sensor sensor(parameters.sensor);
  nlohmann::json document = views::modes_json(sensor);
  document["gravity_m_s2"] = parameters.sensor.gravity_m_s2;
  const bool refined = options.convergence && !has_mesh_file;
  const unsigned int own = parameters.sensor.model.mesh_resolution;
  const unsigned int first = options.first_resolution.value_or(own);
  if (refined) document["convergence"] = convergence_json(views::refine(sensor, first));
  const auto note = sensor.calibration_note();
  if (note) document["calibration_note"] = *note;
  if (options.common.json) {
    print_json(document);
    return;
  }
  std::cout << views::modes_table(sensor).to_text() << sensor.mesh().n_global_active_cells()
            << " cells, " << sensor.space().n_dofs() << " unknowns, " << sensor.mass_kg()
            << " kg\n";
  if (refined) print_convergence(document["convergence"]);
  if (note) std::cout << "Calibrated: " << *note << "\n";
  say_gravity(parameters.sensor.gravity_m_s2);
}

}  // namespace

void add_modes_command(CLI::App& app) {
  const auto options = std::make_shared<ModesOptions>();
  auto* command = app.add_subcommand(
      "modes",
      "Computes resonances of a sensor, with damping, effective masses and mesh convergence");
  options->chosen.add_case_to(*command, sensor_case::CaseUse::modes);
  command->add_flag_callback(
      "--no-convergence", [options] { options->convergence = false; },
      "Leaves out the finer meshes of the refinement table");
  command
      ->add_option("--refine-from", options->first_resolution,
                   "Mesh resolution (1 coarse, 6 fine) at which the refinement table of three "
                   "meshes starts (default: that of the case)")
      ->check(CLI::Range(1, 6));
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa modes sensor.prm\n"
      "  vibrissa modes sensor.prm --no-convergence --set Materials/Silicone/c1=2.4e5 --json\n"
      "  vibrissa modes sensor.prm --set 'Transient/Gravity=0, 0, -9.81'     (standing upright)");
  command->callback([options] { show_modes(*options); });
}

}  // namespace vibrissa::apps
