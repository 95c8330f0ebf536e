#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/command_line/command.h"
#include "apps/jobs/nominal_input.h"

namespace vibrissa::apps {

/// Figures that `vibrissa diagnose` takes in place of records.
struct ResonanceInput {
  std::optional<std::string> resonance, damping, example;

  void add_to(CLI::App& command);
  bool is_given() const { return resonance || damping || example; }
};

/// Explains a gap of two resonances and leaves the answer on standard output and, when a folder is
/// named, there. Throws UserError for figures that contradict each other or the simulation.
void diagnose_resonances(const ResonanceInput& figures, const NominalInput& simulation,
                         const CommonOptions& common,
                         const std::optional<std::filesystem::path>& folder);

}  // namespace vibrissa::apps
