#include "case/sensor_model.h"

#include "fem/sensor/reduction.h"
#include "fem/sensor/sensitivity.h"
#include "signals/base/revision.h"
#include "signals/system/progress.h"

namespace vibrissa::sensor_case {

signals::ReducedModel make_reduced_model(const fem::Sensor& sensor,
                                         const fem::SensorParameters& parameters,
                                         const bool show_progress) {
  signals::ReducedModel model = fem::reduce(sensor);
  model.name = parameters.geometry.fin == meshes::FinShape::none ? "whisker sensor" : "flow sensor";
  model.provenance["program_revision"] = signals::program_revision();
  model.provenance["mesh_sha256"] = sensor.mesh_sha256();
  if (const auto note = sensor.calibration_note()) model.provenance["calibration"] = *note;
  if (parameters.model.sensitivities) {
    signals::Progress progress("sensitivities", fem::n_sensitivity_solutions(parameters),
                               show_progress);
    model.sensitivities =
        fem::sensitivities(parameters, model, [&progress] { progress.advance(); });
  }
  return model;
}

}  // namespace vibrissa::sensor_case
