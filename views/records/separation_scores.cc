#include "views/records/separation_scores.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "report/text/json_file.h"
#include "separation/metrics/coherent_power.h"
#include "separation/metrics/dtw.h"
#include "separation/metrics/dtw_path.h"
#include "separation/metrics/metrics.h"
#include "signals/base/error.h"
#include "signals/base/is_constant.h"

namespace vibrissa::views {

namespace {

constexpr double dtw_window_s = 0.02, largest_delay_s = 0.1;
constexpr separation::Band wind_band{0.1, 10.};

std::vector<double> difference(const std::span<const double> x, const std::span<const double> y) {
  std::vector<double> result(x.size());
  std::transform(x.begin(), x.end(), y.begin(), result.begin(), std::minus<>());
  return result;
}

std::size_t dtw_window(const double rate_hz) {
  return static_cast<std::size_t>(dtw_window_s * rate_hz);
}

void score_against_truth(SeparatedSignal& signal, const std::span<const double> truth,
                         const std::span<const double> estimate, const double rate_hz) {
  signal.sdr_db = separation::sdr_db(truth, estimate);
  signal.mse_n2_m2 = separation::mean_square_error(truth, estimate);
  signal.nrmse = separation::nrmse(truth, estimate);
  signal.band_difference_db =
      separation::band_power_difference_db(truth, estimate, rate_hz, wind_band);
  signal.dtw_n_m = separation::dtw(truth, estimate, dtw_window(rate_hz)).cost_per_pair();
  const auto largest_delay = static_cast<std::size_t>(largest_delay_s * rate_hz);
  signal.delay_ms = 1e3 * separation::delay_samples(truth, estimate, largest_delay) / rate_hz;
}

const std::string paper_ratio_note =
    "Paper's ratio: power of the wind estimate divided by that of the vibration estimate; it is "
    "infinite for a method that removes nothing. ";

std::string score_text(const double value) {
  return report::Cell(value).rounded(4);
}

std::string settling_note(const double settling_s) {
  return "The first " + score_text(settling_s) + " s are left out of all scores.";
}

double root_mean_square(const std::span<const double> x) {
  return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.) /
                   static_cast<double>(x.size()));
}

std::optional<double> vibration_left_db(const std::span<const double> acceleration,
                                        const std::span<const double> measured,
                                        const std::span<const double> estimate,
                                        const double rate_hz) {
  const auto before = separation::coherent_power(acceleration, measured, rate_hz);
  if (!(before.value_n2_m2 > 2. * before.deviation_n2_m2)) return {};
  const auto after = separation::coherent_power(acceleration, estimate, rate_hz);
  return 10. *
         std::log10(std::max(after.value_n2_m2, 2. * after.deviation_n2_m2) / before.value_n2_m2);
}

}  // namespace

SeparatedSignal score(const std::string& name, std::vector<double> wind_moment_n_m,
                      const signals::Record& record, const std::span<const double> truth,
                      const double settling_s) {
  const double rate_hz = record.sampling_rate_hz();
  const auto skipped = static_cast<std::size_t>(settling_s * rate_hz);
  if (skipped + 64 > record.n_samples()) {
    throw signals::UserError("the record of " + std::to_string(record.duration_s()) +
                             " s is too short for the settling time of " +
                             std::to_string(settling_s) +
                             " s; shorten it (--settling, or Separation/Settling time of a case)");
  }
  SeparatedSignal signal;
  signal.name = name;
  signal.wind_moment_n_m = std::move(wind_moment_n_m);
  const auto estimate = std::span<const double>(signal.wind_moment_n_m).subspan(skipped);
  const auto measured = record.channel(signals::channel::base_moment).subspan(skipped);
  const auto vibration = difference(measured, estimate);
  if (std::any_of(vibration.begin(), vibration.end(), [](const double x) { return x != 0.; })) {
    signal.paper_snr_db = separation::paper_snr_db(estimate, vibration);
  }
  signal.rms_n_m = root_mean_square(estimate);
  if (record.has(signals::channel::base_acceleration)) {
    const auto acceleration = record.channel(signals::channel::base_acceleration).subspan(skipped);
    if (!signals::is_constant(acceleration))
      signal.vibration_left_db = vibration_left_db(acceleration, measured, estimate, rate_hz);
  }
  if (!truth.empty()) score_against_truth(signal, truth.subspan(skipped), estimate, rate_hz);
  return signal;
}

nlohmann::json separation_json(const std::vector<SeparatedSignal>& signals) {
  nlohmann::json methods = nlohmann::json::array();
  for (const auto& signal : signals) {
    methods.push_back(
        {{"name", signal.name},
         {"sdr_db", report::json_or_null(signal.sdr_db)},
         {"mse", report::json_or_null(signal.mse_n2_m2)},
         {"nrmse", report::json_or_null(signal.nrmse)},
         {"band_power_difference_db", report::json_or_null(signal.band_difference_db)},
         {"dtw_n_m_per_pair", report::json_or_null(signal.dtw_n_m)},
         {"delay_ms", report::json_or_null(signal.delay_ms)},
         {"paper_snr_db", report::json_or_null(signal.paper_snr_db)},
         {"rms_n_m", signal.rms_n_m},
         {"vibration_left_db", report::json_or_null(signal.vibration_left_db)}});
  }
  return {{"methods", methods}};
}

std::vector<report::Column> metric_columns() {
  return {{"SDR", "dB"},          {"mean square error", "N\u00b2 m\u00b2", 3},
          {"NRMSE", "", 3},       {"wind band power", "dB", 3},
          {"DTW", "N m", 3},      {"delay", "ms", 3},
          {"paper's ratio", "dB"}};
}

std::vector<report::Cell> metric_cells(const SeparatedSignal& s) {
  return {s.sdr_db,  s.mse_n2_m2, s.nrmse,       s.band_difference_db,
          s.dtw_n_m, s.delay_ms,  s.paper_snr_db};
}

report::Table separation_table(const std::vector<SeparatedSignal>& signals) {
  std::vector<report::Column> columns = metric_columns();
  columns.insert(columns.begin(), report::Column{"method", ""});
  report::Table table(columns);
  for (const auto& signal : signals) {
    std::vector<report::Cell> row = metric_cells(signal);
    row.insert(row.begin(), signal.name);
    table.add_row(row);
  }
  return table;
}

report::Table blind_separation_table(const std::vector<SeparatedSignal>& signals) {
  report::Table table({{"method", ""},
                       {"rms moment", "N m", 3},
                       {"vibration left", "dB", 3},
                       {"paper's ratio", "dB"}});
  for (const auto& s : signals)
    table.add_row({s.name, s.rms_n_m, s.vibration_left_db, s.paper_snr_db});
  return table;
}

std::string blind_metric_notes(const double settling_s) {
  return "Vibration left: power that is linearly coherent with the base acceleration, divided by "
         "that in the measured moment, but not less than its statistical detection limit. It does "
         "not show whether wind was lost as well; the scores that do (SDR and others) need the "
         "true wind moment (--truth COLUMN). " +
         paper_ratio_note + settling_note(settling_s);
}

report::Table warping_table(const std::vector<SeparatedSignal>& signals,
                            const signals::Record& record, const std::span<const double> truth,
                            const double settling_s) {
  const double rate_hz = record.sampling_rate_hz();
  const auto skipped = static_cast<std::size_t>(settling_s * rate_hz);
  report::Table table({{"method", ""}, {"truth", "s"}, {"estimate", "s"}});
  for (const auto& signal : signals) {
    const auto estimate = std::span<const double>(signal.wind_moment_n_m).subspan(skipped);
    for (const auto& [i, j] :
         separation::dtw_path(truth.subspan(skipped), estimate, dtw_window(rate_hz))) {
      table.add_row({signal.name, record.time_s(skipped + i), record.time_s(skipped + j)});
    }
  }
  return table;
}

std::string metric_notes(const double settling_s) {
  return "SDR: signal-to-distortion ratio against the true wind moment. Wind band power: power of "
         "the estimate divided by that of the true wind moment, from " +
         score_text(wind_band.low_hz) + " to " + score_text(wind_band.high_hz) +
         " Hz. DTW: dynamic time warping with unit steps, mean absolute cost per pair of the path, "
         "window ±" +
         score_text(1e3 * dtw_window_s) + " ms. " + paper_ratio_note + settling_note(settling_s);
}

}  // namespace vibrissa::views
