#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/solid/jobs/case_options.h"
#include "report/pictures.h"
#include "views/records/separation_scores.h"

namespace vibrissa::apps {

struct RunOutcome {
  std::filesystem::path folder;
  nlohmann::json summary;  // as in summary.json
  std::vector<views::SeparatedSignal> separated;
  report::PictureReport pictures;
};

/// The main job: sensor, resonances, base motion and wind, records, identification, separation,
/// pictures; everything into a new run folder, summary.json last. Throws UserError for a bad case
/// or bad inputs before anything is written, and when writing fails. With several processes the
/// outcome of the first is whole; the others take part in what the solid needs.
RunOutcome run_job(const CaseOptions& chosen, const std::vector<std::string>& command_line,
                   bool quiet);

}  // namespace vibrissa::apps
