#include "reproduction/paper_sensors.h"

#include <cmath>
#include <numbers>

#include "case/case_file.h"
#include "case/sensor_model.h"
#include "fem/linalg/solver_session.h"
#include "fem/sensor/sensor.h"
#include "signals/system/progress.h"

namespace vibrissa::reproduction {

namespace {

fem::SensorParameters read_sensor(const std::filesystem::path& file) {
  fem::SensorParameters parameters = sensor_case::CaseFile(file).read().sensor;
  parameters.model.sensitivities = false;  // not needed here
  return parameters;
}

signals::ReducedModel built_sensor(signals::ReducedModel model) {
  model.name = "built flow sensor (simulated with its published parameters)";
  const double first_hz = model.modes.front().frequency_hz;
  for (auto& mode : model.modes) {
    if (mode.frequency_hz > first_hz * (1. + 1e-3)) break;
    mode.frequency_hz = built_frequency_hz;
    mode.damping_ratio = built_damping_ratio;
  }
  return model;
}

signals::Beam free_wire(const fem::SensorParameters& whisker) {
  const double radius = 0.5 * whisker.geometry.wire_diameter;
  const double area = std::numbers::pi * radius * radius;
  const auto& wire = whisker.materials.wire;
  return {whisker.geometry.free_length,
          wire.youngs_modulus_at_rest() * 0.25 * area * radius * radius, wire.density * area, 0.05};
}

}  // namespace

FlowSensors make_flow_sensors(const std::filesystem::path& flow_case, const bool show_progress) {
  const auto flow = read_sensor(flow_case);
  const fem::SolverSession session;
  signals::Progress progress("sensor", 1, show_progress);
  auto simulated = sensor_case::make_reduced_model(fem::Sensor(flow), flow, false);
  progress.advance();
  auto built = built_sensor(simulated);
  return {std::move(simulated), std::move(built)};
}

PaperSensors make_paper_sensors(const std::filesystem::path& flow_case,
                                const std::filesystem::path& whisker_case,
                                const bool show_progress) {
  const auto flow = read_sensor(flow_case), whisker = read_sensor(whisker_case);
  const fem::SolverSession session;
  signals::Progress progress("sensors", 2, show_progress);
  PaperSensors sensors;
  sensors.flow = sensor_case::make_reduced_model(fem::Sensor(flow), flow, false);
  progress.advance();
  sensors.whisker = sensor_case::make_reduced_model(fem::Sensor(whisker), whisker, false);
  progress.advance();
  sensors.built = built_sensor(sensors.flow);
  sensors.wire = free_wire(whisker);
  return sensors;
}

}  // namespace vibrissa::reproduction
