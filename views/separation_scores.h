#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/figures/table.h"
#include "signals/record/record.h"

namespace vibrissa::views {

/// One method's estimate of the wind moment of a record, with its score where the truth is known.
struct SeparatedSignal {
  std::string name;
  std::vector<double> wind_moment_n_m;
  /// Power of the wind estimate over that of the vibration estimate, what the reference paper calls
  /// SNR; nothing when the method removes nothing.
  std::optional<double> paper_snr_db;
  double rms_n_m = 0.;
  /// Power that goes with the base acceleration, over that of the measured moment, but never less
  /// than two standard deviations of what chance shows (separation/metrics/coherent_power.h).
  /// Nothing when there is no base acceleration, or none that the measured moment goes with.
  std::optional<double> vibration_left_db;
  std::optional<double> sdr_db, mse_n2_m2, nrmse, band_difference_db, dtw_n_m, delay_ms;
};

/// Scores an estimate. The first settling_s of the record are left out. truth: empty when unknown.
SeparatedSignal score(const std::string& name, std::vector<double> wind_moment_n_m,
                      const signals::Record& record, std::span<const double> truth,
                      double settling_s);

/// {"methods": [{"name", "sdr_db", "mse", "nrmse", "band_power_difference_db", "dtw_n_m_per_pair",
///  "delay_ms", "paper_snr_db", "rms_n_m", "vibration_left_db"}]}; null where no truth is given,
///  but for the last three; those where their members say so.
nlohmann::json separation_json(const std::vector<SeparatedSignal>& signals);
/// The scores as columns of a table, and one signal's cells of them.
std::vector<report::Column> metric_columns();
std::vector<report::Cell> metric_cells(const SeparatedSignal& signal);
/// One row a method.
report::Table separation_table(const std::vector<SeparatedSignal>& signals);
/// What can be said without the true wind moment, and what it means; one row a method.
report::Table blind_separation_table(const std::vector<SeparatedSignal>& signals);
std::string blind_metric_notes(double settling_s);

/// What the time warping of the DTW score lays beside what: method, time of the truth and time of
/// the estimate [s], one row a pair. truth: not empty.
report::Table warping_table(const std::vector<SeparatedSignal>& signals,
                            const signals::Record& record, std::span<const double> truth,
                            double settling_s);

/// What the columns mean: windows, bands, normalisation.
std::string metric_notes(double settling_s);

}  // namespace vibrissa::views
