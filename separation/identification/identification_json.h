#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "separation/identification/hold_check.h"
#include "separation/identification/identify.h"
#include "separation/identification/identify_response.h"
#include "separation/identification/output_only.h"
#include "separation/identification/residual_tests.h"
#include "separation/model/poles_zeros.h"

namespace vibrissa::separation {

/// {"modes": [{"frequency_hz", "frequency_sd_hz", "damping_ratio", "damping_sd",
/// "static_gain_kg_m", "static_gain_sd_kg_m"}], "direct_term", "direct_term_sd", "order", "end"}.
nlohmann::json fitted_json(const FittedBvrm& fit);
/// The same with "fit_percent" of the held-out lines.
nlohmann::json identified_response_json(const IdentifiedResponse& identified);
/// The same with "fit_percent" and "vaf_percent" of the held-out record, and "hold".
nlohmann::json identification_json(const Identification& identification);

/// {"modes": [{"frequency_hz", "frequency_sd_hz", "damping_ratio", "damping_sd", "n_orders"}],
///  "undamped": [{"frequency_hz", "frequency_sd_hz"}], "n_orders", "words"}.
nlohmann::json output_only_json(const OutputOnlyIdentification& found);

/// Evidence of a record about a model, in addition to the fit.
struct ModelEvidence {
  PolesAndZeros poles_zeros;
  ResidualTests residual;
  HoldDiagnosis hold;  // hold of the input between its samples
};

/// Tests the residual on the held-out record and the hold on the fitted record.
ModelEvidence examine(const Identification& identification, const signals::Record& fitted,
                      const signals::Record& held_out);

/// {"poles": [{"real_rad_s", "imaginary_rad_s", "real_sd_rad_s", "imaginary_sd_rad_s"}], "zeros",
///  "residual_white", "residual_independent_of_input", "residual_words", "hold_words"}.
nlohmann::json evidence_json(const ModelEvidence& evidence);

/// The document of `vibrissa identify --json`: both of the above, and "order_words", "method".
nlohmann::json identification_report(const Identification& identification,
                                     const ModelEvidence& evidence, const std::string& method);

}  // namespace vibrissa::separation
