#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "separation/identification/hold_check.h"
#include "separation/identification/identify.h"
#include "separation/identification/identify_response.h"
#include "separation/identification/output_only.h"
#include "separation/metrics/residual_tests.h"
#include "separation/model/poles_zeros.h"
#include "separation/verdict/verdict.h"

namespace vibrissa::separation {

/// Unit of the gains of a moment per acceleration.
inline const std::string moment_gain_unit = "kg m";

/// {"modes": [{"frequency_hz", "frequency_sd_hz", "damping_ratio", "damping_sd",
/// "static_gain_kg_m", "static_gain_sd_kg_m"}], "direct_term", "direct_term_sd", "gain_unit",
/// "order", "end"}; in another unit than kg m the gains are "static_gain" and "static_gain_sd".
nlohmann::json fitted_json(const FittedBvrm& fit, const std::string& gain_unit = moment_gain_unit);
/// The document of `vibrissa identify --frequency-response --json`: the same and that of
/// add_verdict(), with "fit_percent" of the held-out lines and "conjugated".
nlohmann::json identified_response_json(const IdentifiedResponse& identified,
                                        const Verdict& verdict,
                                        const std::string& gain_unit = moment_gain_unit);
/// The same with "fit_percent" and "vaf_percent" of the held-out record, and "hold".
nlohmann::json identification_json(const Identification& identification);

/// Adds "usable", "verdict" (the sentence), "band_hz" [low, high], and moves the modes that are not
/// determined from "modes" to "not_determined", those of which only the frequency is told to
/// "frequency_only", each with its "reason".
void add_verdict(const Verdict& verdict, nlohmann::json& document);

/// {"modes": [{"frequency_hz", "frequency_sd_hz", "damping_ratio", "damping_sd", "n_orders"}],
///  "undamped": [{"frequency_hz", "frequency_sd_hz"}], "n_orders", "words"}.
nlohmann::json output_only_json(const OutputOnlyIdentification& found);

/// Evidence of a record about a model, in addition to the fit.
struct ModelEvidence {
  PolesAndZeros poles_zeros;
  ResidualTests residual;
  HoldDiagnosis hold;  // hold of the input between its samples
  Verdict verdict;
};

/// Tests the residual of the scored model on the held-out record, and the hold of a usable model on
/// the fitted record. An error below exact_share of the moment accuses neither delay nor order nor
/// hold.
ModelEvidence examine(const Identification& identification, const signals::Record& fitted,
                      const signals::Record& held_out);

/// {"poles": [{"real_rad_s", "imaginary_rad_s", "real_sd_rad_s", "imaginary_sd_rad_s"}], "zeros",
///  "residual_white", "residual_independent_of_input", "residual_words", "hold_words"}.
nlohmann::json evidence_json(const ModelEvidence& evidence);

/// The document of `vibrissa identify --json`: identification_json(), evidence_json(),
/// add_verdict(), and "order_words", "scatter_words", "method"; with "delay_s" and
/// "delay_sd_s" when a usable model has a delay between the channels.
nlohmann::json identification_report(const Identification& identification,
                                     const ModelEvidence& evidence, const std::string& method);

}  // namespace vibrissa::separation
