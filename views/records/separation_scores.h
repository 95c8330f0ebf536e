#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/figures/table.h"
#include "signals/record/record.h"

namespace vibrissa::views {

/// One method's estimate of the wind moment of a record, with its scores where the true wind moment
/// is known.
struct SeparatedSignal {
  std::string name;
  std::vector<double> wind_moment_n_m;
  /// Power of the wind estimate divided by that of the vibration estimate, called SNR by the
  /// reference paper; nothing when the method removes nothing.
  std::optional<double> paper_snr_db;
  double rms_n_m = 0.;
  /// Power coherent with the base acceleration, divided by that in the measured moment, but at
  /// least two of its standard deviations (separation/metrics/coherent_power.h). Nothing when there
  /// is no base acceleration, or when the measured moment is not coherent with it.
  std::optional<double> vibration_left_db;
  std::optional<double> sdr_db, mse_n2_m2, nrmse, band_difference_db, dtw_n_m, delay_ms;
};

/// Scores an estimate. The first settling_s of the record are left out. truth: empty when unknown.
SeparatedSignal score(const std::string& name, std::vector<double> wind_moment_n_m,
                      const signals::Record& record, std::span<const double> truth,
                      double settling_s);

/// {"methods": [{"name", "sdr_db", "mse", "nrmse", "band_power_difference_db", "dtw_n_m_per_pair",
/// "delay_ms", "paper_snr_db", "rms_n_m", "vibration_left_db"}]}. All but the last three are null
/// without the true wind moment.
nlohmann::json separation_json(const std::vector<SeparatedSignal>& signals);
/// The scores as table columns, and the cells of one signal.
std::vector<report::Column> metric_columns();
std::vector<report::Cell> metric_cells(const SeparatedSignal& signal);
/// One row per method.
report::Table separation_table(const std::vector<SeparatedSignal>& signals);
/// Scores that need no true wind moment, one row per method, and notes on their meaning.
report::Table blind_separation_table(const std::vector<SeparatedSignal>& signals);
std::string blind_metric_notes(double settling_s);

/// The path of the DTW score: method, time of the true signal and time of the estimate [s], one row
/// per pair. truth: not empty.
report::Table warping_table(const std::vector<SeparatedSignal>& signals,
                            const signals::Record& record, std::span<const double> truth,
                            double settling_s);

/// Notes on the columns: windows, bands, normalisation.
std::string metric_notes(double settling_s);

}  // namespace vibrissa::views
