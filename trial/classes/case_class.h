#pragma once

#include <string>

namespace vibrissa::trial {

/// Kind of a case of a blind trial: what its sensor's records ask.
enum class CaseClass {
  single,
  pair,
  triple,
  none,
  calibration_only,  // building tolerances of modulus, damping, gains and drag only
  nameless,          // an effect that is in no catalogue
  left_out,          // an effect that is removed from the catalogue of the diagnosis
  below_limit,       // an effect of a quarter of the detection limit
  wrong_metadata     // a take with a wrong excitation (wind) or a wrong period
};

/// Name in labels and scores, e.g. "below_limit".
std::string to_string(CaseClass kind);

/// The class of a name; of a trial of version 1, too ("retune_only" is calibration_only).
/// Throws UserError that lists the known names. Proven by tests/trial/classes/case_class_test.cc.
CaseClass parse_case_class(const std::string& name);

}  // namespace vibrissa::trial
