#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "separation/identification/identify.h"
#include "separation/nonlinear/law_choice.h"

namespace vibrissa::separation {

struct NonlinearIdentification {
  Identification linear;    // of the quietest part that the record has
  FittedNonlinearBvrm fit;  // to all samples; its model has no law where the record asks for none
  NonlinearBvrm scored;     // the model that the held-out part scored
  LawChoice choice;
  /// Root-mean-square errors on the held-out part, in free simulation; only its initial state and
  /// offset are estimated.
  double held_out_rms_n_m = 0., linear_held_out_rms_n_m = 0.;
  double held_out_fit_percent = 0.;
  std::string words;  // the law that the record asks for

  bool has_law() const { return !fit.model.law.empty(); }
};

/// Identifies the nonlinear base vibration response model: the linear model from the quietest part
/// (where one third of the fit record has less than half of the level of another, else from the
/// whole fit record) gives order, hold and unknowns; choose_law() the law, for the model with all
/// modes and for its strongest mode alone; then the model is fitted to the fit record, scored by
/// the held-out record, and fitted to both. Without held_out the last part of the record scores
/// (hold_out_part()). Throws UserError as identify_bvrm() for records that are too short or not
/// excited, and for options.method other than output_error. Proven by
/// tests/separation/nonlinear/identify_nonlinear_test.cc.
NonlinearIdentification identify_nonlinear(const signals::Record& record,
                                           const std::optional<signals::Record>& held_out = {},
                                           const IdentifyOptions& options = {});

/// {"law": [{"term", "coefficient", "coefficient_sd", "unit"}], "readout", "modes", "direct_term",
/// "hold", "end", "held_out_rms_N_m", "linear_held_out_rms_N_m", "fit_percent",
/// "largest_deflection_m", "largest_speed_m_s", "trials": [{"term", "readout", "unseen_rms_N_m",
/// "gain_deviations", "accepted"}], "words"}: the document of
/// `vibrissa identify --nonlinear --json`.
nlohmann::json nonlinear_report(const NonlinearIdentification& found);

}  // namespace vibrissa::separation
