#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/figures/table.h"
#include "signals/record/record.h"
#include "signals/spectra/best_linear_approximation.h"
#include "views/records/bode_data.h"

namespace vibrissa::apps {

/// How a frequency response is measured from records of base acceleration and base moment.
enum class ResponseMethod { periods, welch, local_polynomial, robust, fast };

struct ResponseOptions {
  std::optional<std::string> method;   // by name; nothing: periods when a period is given, or welch
  std::size_t period_samples = 0;      // 0: not periodic
  std::size_t segment_samples = 2048;  // of Welch's method
};

/// A line a method: its name and what it is, for the user.
std::string response_method_help();

/// A further column beside the response, one value a frequency.
struct ResponseEvidence {
  std::string name;  // with its unit, as in the CSV
  std::vector<double> values;
};

struct MeasuredResponse {
  views::BodeCurve curve;
  std::vector<ResponseEvidence> evidence;          // noise and distortion, as far as told
  std::vector<signals::DetectedOutput> detection;  // of the fast method
  std::string words;                               // what the method tells, and what it cannot
};

/// Measures the response of one record, or for the robust method of several realisations. Throws
/// UserError for an unknown method, a period that the method needs or does not take, one record
/// too many or too few, and what the method itself throws.
MeasuredResponse measure_response(const std::vector<signals::Record>& records,
                                  const ResponseOptions& options);

/// frequency_hz, magnitude, phase, then standard deviation, coherence and evidence where there are.
report::Table response_table(const MeasuredResponse& measured);
/// frequency_hz, role, power and noise_power [N^2 m^2] of the lines that were not excited.
report::Table detection_table(const std::vector<signals::DetectedOutput>& detection);
/// {"unit", "convention", "points": [{"frequency_hz", "real", "imaginary", "coherence",
///  "standard_deviation", evidence by its name}], "detection", "words"}; null for what a line does
/// not tell.
nlohmann::json response_json(const MeasuredResponse& measured);

}  // namespace vibrissa::apps
