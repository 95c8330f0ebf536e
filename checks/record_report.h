#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/checks/finding.h"
#include "separation/metrics/metrics.h"
#include "separation/model/fitted_bvrm.h"
#include "signals/files/dataset.h"

namespace vibrissa::checks {

/// note: no command is worse for it. limits: some result is missing or doubtful. stops: at least
/// one command cannot work.
enum class Severity { note, limits, stops };
std::string to_string(Severity severity);

struct Finding {
  diagnosis::FindingKind kind{};
  std::string channel{};          // empty: the whole record
  std::optional<double> value{};  // what the check measured
  std::string unit{};             // of the value
  std::string sentence{};         // what was found and what to do
  Severity severity = Severity::note;
};

/// A line of the mains or one of its harmonics.
struct HumLine {
  double frequency_hz = 0.;
  double rms = 0.;  // in the unit of the channel
};

/// One channel by itself, in its own unit.
struct ChannelFacts {
  std::string name{}, unit{};
  double lowest = 0., highest = 0., mean = 0., rms = 0.;  // rms about the mean
  std::optional<double> drift_per_s{};                    // where it is told from noise
  double drift_share = 0.;                                // of the variance
  bool never_falls = false;                               // as a time or a counter
  std::optional<std::size_t> skipped{};  // numbers that a counter of samples passes over
  std::optional<double> step{};          // of the converter, where all values lie on a grid
  std::optional<double> noise{};         // per sample; an upper bound where the drive hides it
  std::vector<HumLine> hum{};
};

enum class DriveKind { none, random_or_other, periodic, hits };
std::string to_string(DriveKind kind);

/// How the base was driven.
struct DriveFacts {
  DriveKind kind = DriveKind::none;
  std::size_t period_samples = 0, n_hits = 0;
  std::array<double, 3> level_m_s2{};  // rms in each third of the record
  std::optional<double> end_s{};       // from then on the base rests
};

/// The relation between base acceleration and base moment.
struct ResponseFacts {
  separation::Band band{};
  std::size_t n_lines = 0, n_coherent = 0;  // Welch's lines
  /// Share of the variance of the moment that follows the base acceleration, and its deviation;
  /// nothing for hits.
  std::optional<separation::Estimate> coherent_share{};
  std::optional<separation::Estimate> delay_s{};  // of the moment; nothing: none is found
  double gain_kg_m = 0.;                          // median magnitude of the response
};

/// What a record is, and all that was found about it.
struct RecordReport {
  std::string name{};
  std::string reading{};  // how the file was read; empty for a record that is not from a file
  double sampling_rate_hz = 0., start_s = 0., duration_s = 0.;
  std::size_t n_samples = 0;
  signals::Excitation excitation{};
  signals::Split split = signals::Split::fit;
  bool has_wind_speed = false;
  std::vector<ChannelFacts> channels{};
  DriveFacts drive{};
  std::optional<ResponseFacts> response{};
  std::vector<Finding> findings{};
};

}  // namespace vibrissa::checks
