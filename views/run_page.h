#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/page/page.h"
#include "separation/identification/identify.h"
#include "views/separation_scores.h"

namespace vibrissa::views {

/// What the main job has to say.
struct RunPageParts {
  report::Table modes;
  double resonance_hz = 0., damping_ratio = 0.;  // of the first mode
  std::optional<std::string> calibration_note{};
  separation::Identification identified{};
  std::vector<SeparatedSignal> separated{};
  double settling_s = 0.;                     // left out of the scores
  std::vector<report::Figure> figures{};      // "bode", "records", "separation" and "spectra"
  std::vector<report::ModePicture> shapes{};  // of modes; empty without VTK files
};

/// Resonances and shapes, response, records, separation. Proven by tests/apps/commands_test.cc.
report::Page run_page(const RunPageParts& parts);

}  // namespace vibrissa::views
