#include "apps/jobs/nominal_input.h"

#include <filesystem>

#include "case/case_file.h"
#include "case/rig.h"
#include "case/sensor_model.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "fem/linalg/solver_session.h"
#include "signals/base/error.h"

namespace vibrissa::apps {
namespace {

signals::ReducedModel solve_case(const std::string& file, bool show_progress) {
  const sensor_case::Case parameters = sensor_case::CaseFile(file).read();
  sensor_case::refuse_gravity(parameters, "the reduced model");
  const fem::SolverSession session;
  return sensor_case::make_reduced_model(fem::Sensor(parameters.sensor), parameters.sensor,
                                         show_progress);
}

}  // namespace

double NominalInput::Simulation::sampling_rate_hz() const {
  return dataset.records.empty() ? 0. : dataset.records.front().record.sampling_rate_hz();
}

signals::ReducedModel NominalInput::read_model(const bool show_progress) const {
  const bool is_case = std::filesystem::path(*model).extension() == ".prm";
  return is_case ? solve_case(*model, show_progress) : signals::read_reduced_model(*model);
}

void NominalInput::check_one_is_given() const {
  if (model.has_value() == simulation.has_value())
    throw signals::UserError(
        "give the simulation either as --model CASE.prm|model.json or as --sim DATASET");
}

NominalInput::Simulation NominalInput::read(const bool show_progress) const {
  check_one_is_given();
  if (simulation) {
    signals::Dataset dataset = signals::read_dataset(*simulation);
    return {diagnosis::identify_nominal(dataset), std::move(dataset)};
  }
  if (diagnosis::is_updated_model(*model)) return {diagnosis::read_updated_model(*model), {}};
  return {diagnosis::nominal_from(read_model(show_progress)), {}};
}

}  // namespace vibrissa::apps
