#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "separation/metrics/metrics.h"
#include "signals/record/record.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

/// The coherence that the largest of so many lines of unrelated noise exceeds in one record of a
/// hundred: 1 - (0.01 / lines)^(1 / (averages - 1)) (Carter, Knapp & Nuttall 1973).
double coherence_limit(std::size_t n_lines, double averages);

/// Welch's response from base acceleration to base moment, with the lines where both are related.
struct CoherentLines {
  signals::FrequencyResponse response{};
  signals::WelchOptions welch{};  // by which it was estimated
  double averages = 0.;
  double limit = 1.;                 // coherence_limit()
  std::vector<std::size_t> lines{};  // places in the response whose coherence is above the limit
};

/// Nothing for a record shorter than two segments (an eighth of the record, 32 to 2048 samples).
/// Throws UserError as welch_response does. Proven by tests/separation/verdict/verdict_test.cc.
std::optional<CoherentLines> coherent_lines(const signals::Record& record);

/// The band of a hammer hit: up to the first line at which the pulse has less than a tenth of its
/// largest amplitude, as usual in impact testing (20 dB). Nothing when the input is no hit.
std::optional<Band> hit_band(const signals::Record& record);

/// found: coherent_lines() of the record. The band of the hit, or the band between the lowest and
/// the highest coherent line; the whole band when there is none.
Band coherent_band(const signals::Record& record, const std::optional<CoherentLines>& found);
inline Band coherent_band(const signals::Record& record) {
  return coherent_band(record, coherent_lines(record));
}

}  // namespace vibrissa::separation
