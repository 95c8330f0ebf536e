#pragma once

#include <functional>
#include <optional>
#include <string>

#include "diagnosis/model/updated_model.h"
#include "signals/files/dataset.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::apps {

/// The reduced model of a case file, by solving the solid. Programs that cannot solve one never
/// meet a case file.
using CaseSolver =
    std::function<signals::ReducedModel(const std::string& file, bool show_progress)>;
void set_case_solver(CaseSolver solver);

/// How a command takes the simulation: as a model or as records.
struct NominalInput {
  std::optional<std::string> model, simulation;

  /// The simulation and its records, none when it is a model. Throws UserError unless one of the
  /// two is given, and what their readers throw.
  struct Simulation {
    diagnosis::UpdatedModel model;
    signals::Dataset dataset;
    /// Of the first record; 0: none.
    double sampling_rate_hz() const;
  };
  /// of_real: how the real sensor's files are read; its columns and rate are taken for --sim, too,
  /// where --sim has no channel under a name of its own.
  Simulation read(bool show_progress, const signals::ReadOptions& of_real = {}) const;
  /// What read() does first.
  void check_one_is_given() const;
  /// The model alone, which must be a case file or a reduced model.
  signals::ReducedModel read_model(bool show_progress) const;
};

}  // namespace vibrissa::apps
