#pragma once

#include <optional>
#include <string>
#include <vector>

#include "separation/identification/identify.h"
#include "separation/identification/identify_response.h"
#include "separation/metrics/metrics.h"
#include "separation/model/sampled_bvrm.h"
#include "signals/record/record.h"

namespace vibrissa::separation {

/// A pair of poles of a model that the data do not determine as a mode, or not whole.
struct UndeterminedMode {
  std::size_t mode = 0;  // place in the fit
  std::string reason;
  /// Of the peak, where the phase of the response contradicts the mode and the amplitude alone
  /// tells its frequency.
  std::optional<Estimate> peak_hz = std::nullopt;
  bool damping_is_resolved = true;
};

/// The frequency [Hz] of such a pair of poles.
const Estimate& frequency_of(const UndeterminedMode& entry, const FittedBvrm& fit);

/// Whether a result can be believed.
struct Verdict {
  bool usable = false;
  /// Usable or not, for what band, how good on unseen data; the delay of a usable model.
  std::string sentence;
  Band band;                                     // where the data tell the model
  std::vector<std::size_t> determined;           // places in the fit
  std::vector<UndeterminedMode> frequency_only;  // peaks whose damping the lines do not tell
  std::vector<UndeterminedMode> undetermined;

  /// What the file of the model states.
  StatedVerdict stated() const { return {usable, sentence}; }
};

/// A pair of poles is a mode when the fit converged, it lies within the band, oscillates, decays
/// within the record, and its damping ratio is above twice its deviation. A model is usable when it
/// has a mode and explains more of the variance of unseen data than it leaves. Proven by
/// tests/separation/verdict/verdict_test.cc.
Verdict judge(const Identification& identification, const signals::Record& fitted);

/// The same for a frequency response, whose band is that of its lines; when their coherence is
/// known, it is said, and the band is that of the lines that the model explains more than it
/// leaves. A resonance with less than two lines within its half-power width 2 zeta f has no damping
/// that the lines tell, unless the model is exact; its frequency is told where the noise moves it
/// by less than the lines are apart. A peak whose phase rises (phase_rises()) is no answer to the
/// base; it has the frequency of its amplitude.
Verdict judge(const IdentifiedResponse& identified, const signals::FrequencyResponse& measured);

}  // namespace vibrissa::separation
