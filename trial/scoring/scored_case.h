#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trial/classes/case_class.h"
#include "trial/classes/circumstances.h"

namespace vibrissa::trial {

/// One case: truth and diagnosis.
struct ScoredCase {
  std::string name;
  CaseClass kind = CaseClass::none;
  std::optional<Circumstances> circumstances{};  // nothing in a trial of complete records
  std::string hold{};                            // of the simulation's input, as the label says
  std::string truth, verdict;                    // truth: the correct verdict
  std::string effects{};                         // names of the generator
  std::vector<std::string> notes{};              // answers that are right or wrong with or without
  double size_in_limits = 0.;                    // of the smallest effect; 0 without one
  int exit_status = 0;
  double probability = 0., seconds = 0.;
  double probability_of_tried = 1.;               // that any tested answer is right
  double probability_of_outside = 0.;             // of a cause outside the catalogue
  std::map<std::string, double> probabilities{};  // of all answers that are listed
  bool right = false, right_within_set = false, in_top_three = false, in_confidence_set = false;
  bool links_right = false;
  std::size_t confidence_set_size = 0;
  std::optional<double> gap_closed{}, transfer_gap_closed{};
  std::vector<double> parameter_errors{};  // divided by the stated standard deviation
  /// Does exactly one answer, the right one, remain after a further experiment? Nothing where none
  /// was made.
  std::optional<bool> resolved_as_recommended{}, resolved_by_chance{};
  std::vector<bool> calibrations_covered{};  // does the interval of each hold its true value?

  /// Is there an effect, and does each belong to a note (least_gap_share)?
  bool has_notes_alone() const { return !notes.empty() && truth == "none"; }
  /// Verdicts on sensors that are off in their calibrations are compared without calibrations.
  bool is_off_in_calibrations() const;
};

/// Name of an answer without calibrations and what they imitate (is_a_calibration()); "none" where
/// nothing remains.
std::string without_calibrations(const std::string& name);

/// Compares an answer with its label: effects below least_gap_share do not count. Proven by
/// tests/apps/trial_test.cc.
ScoredCase score_case(const std::string& name, const nlohmann::json& label,
                      const nlohmann::json& answer);

}  // namespace vibrissa::trial
