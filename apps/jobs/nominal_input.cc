#include "apps/jobs/nominal_input.h"

#include <exception>
#include <filesystem>
#include <utility>

#include "diagnosis/model/updated_model.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "signals/base/error.h"

namespace vibrissa::apps {
namespace {

CaseSolver& case_solver() {
  static CaseSolver solver;
  return solver;
}

// The error of the names in the file itself is the one that is said.
signals::Dataset read_simulated(const std::string& source, const signals::ReadOptions& of_real) {
  try {
    return signals::read_dataset(source, {.takes_responses = true});
  } catch (const signals::UserError&) {
    if (of_real.columns.empty()) throw;
    const std::exception_ptr failure = std::current_exception();
    try {
      return signals::read_dataset(source, {.columns = of_real.columns,
                                            .sampling_rate_hz = of_real.sampling_rate_hz,
                                            .text = of_real.text,
                                            .takes_responses = true});
    } catch (const signals::UserError&) {
      std::rethrow_exception(failure);
    }
  }
}

}  // namespace

void set_case_solver(CaseSolver solver) {
  case_solver() = std::move(solver);
}

double NominalInput::Simulation::sampling_rate_hz() const {
  return dataset.records.empty() ? 0. : dataset.records.front().record.sampling_rate_hz();
}

signals::ReducedModel NominalInput::read_model(const bool show_progress) const {
  const bool is_case = std::filesystem::path(*model).extension() == ".prm";
  return is_case ? case_solver()(*model, show_progress) : signals::read_reduced_model(*model);
}

void NominalInput::check_one_is_given() const {
  if (model.has_value() == simulation.has_value())
    throw signals::UserError(
        "give the simulation either as --model CASE.prm|model.json or as --sim DATASET");
}

NominalInput::Simulation NominalInput::read(const bool show_progress,
                                            const signals::ReadOptions& of_real) const {
  check_one_is_given();
  if (simulation) {
    signals::Dataset dataset = read_simulated(*simulation, of_real);
    return {diagnosis::identify_nominal(dataset), std::move(dataset)};
  }
  if (diagnosis::is_updated_model(*model)) return {diagnosis::read_updated_model(*model), {}};
  return {diagnosis::nominal_from(read_model(show_progress)), {}};
}

}  // namespace vibrissa::apps
