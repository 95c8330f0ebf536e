#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/page/page.h"
#include "separation/identification/identify.h"
#include "views/records/separation_scores.h"

namespace vibrissa::views {

/// Results of `vibrissa run`.
struct RunPageParts {
  report::Table modes;
  double resonance_hz = 0., damping_ratio = 0.;  // of the first mode
  std::optional<std::string> calibration_note{};
  separation::Identification identified{};
  std::vector<SeparatedSignal> separated{};
  double settling_s = 0.;                     // at the start of the record, left out of the scores
  std::vector<report::Figure> figures{};      // "bode", "records", "separation" and "spectra"
  std::vector<report::ModePicture> shapes{};  // mode shapes; empty without VTK files
};

/// Report page with resonances and mode shapes, response, records, separation. Proven by
/// tests/apps/commands_test.cc.
report::Page run_page(const RunPageParts& parts);

}  // namespace vibrissa::views
