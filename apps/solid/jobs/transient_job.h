#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/solid/jobs/case_options.h"

namespace vibrissa::apps {

struct TransientOutcome {
  std::filesystem::path folder;
  bool is_done = false;    // false: interrupted; the checkpoint has what is there
  nlohmann::json summary;  // as in summary.json, of a run that is done
};

/// The case's full-order solid through the whole record, into a new run folder: record.csv,
/// energy.csv (finite strain), substeps.csv (where they are chosen), transient.pvd with its frames,
/// summary.json last; checkpoint.h5 on the way, taken away at the end. Throws UserError for a bad
/// case or bad inputs before anything is written, and as simulate_nonlinear. Proven by
/// tests/apps/transient_test.cc.
TransientOutcome run_transient(const CaseOptions& chosen,
                               const std::vector<std::string>& command_line, bool show_progress);

/// Goes on with a run that was interrupted or killed; the files at the end are byte for byte those
/// of a run that was not. Throws UserError when the folder holds no such run, one that is done, or
/// a checkpoint that does not fit (fem/motion/checkpoint.h).
TransientOutcome resume_transient(const std::filesystem::path& folder, bool show_progress);

}  // namespace vibrissa::apps
