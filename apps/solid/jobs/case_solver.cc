#include "apps/solid/jobs/case_solver.h"

#include "case/case_file.h"
#include "case/rig.h"
#include "case/sensor_model.h"
#include "fem/linalg/solver_session.h"

namespace vibrissa::apps {

signals::ReducedModel solve_case(const std::string& file, bool show_progress) {
  const sensor_case::Case parameters = sensor_case::CaseFile(file).read();
  sensor_case::refuse_gravity(parameters, "the reduced model");
  const fem::SolverSession session;
  return sensor_case::make_reduced_model(fem::Sensor(parameters.sensor), parameters.sensor,
                                         show_progress);
}

}  // namespace vibrissa::apps
