#pragma once

#include <optional>
#include <string>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// A record of another sensor, mount or level than its dataset says.
struct MisplacedRecord {
  std::string name;
  double log_odds = 0.;  // for this against the best answer with all records [nats]
  HypothesisFit own;     // of this record alone
  /// Ratios of the calibrations that this record alone asks for, as "stiffness 0.83".
  std::string asks_for() const;
};

/// The fit record that contradicts all others, if there is one: recalibrated on its own it fits,
/// the other records fit without it, and together this is far more probable than any answer for all
/// records. It takes three records with motion. Proven by
/// tests/diagnosis/search/misplaced_record_test.cc.
std::optional<MisplacedRecord> misplaced_record(const Experiment& experiment,
                                                const SearchResult& result, std::size_t n_threads);

}  // namespace vibrissa::diagnosis
