#include "apps/jobs/measured_response.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "report/text/json_file.h"
#include "signals/base/error.h"
#include "signals/spectra/local_polynomial.h"

namespace vibrissa::apps {

namespace {

using signals::Record;
using signals::UserError;

struct NamedMethod {
  ResponseMethod method;
  std::string name, about;
  bool needs_period;
};

const std::array<NamedMethod, 5> methods = {
    {{ResponseMethod::periods, "periods", "averages of whole periods, no leakage", true},
     {ResponseMethod::welch, "welch", "averaged segments of any record", false},
     {ResponseMethod::local_polynomial, "local-polynomial",
      "any record, at each of its lines, no leakage; gives the noise", false},
     {ResponseMethod::robust, "robust",
      "best linear approximation from realisations (--realisation); gives noise and distortion",
      true},
     {ResponseMethod::fast, "fast",
      "best linear approximation from the detection lines of one odd or random-odd record; gives "
      "noise, even and odd distortion",
      true}}};

const std::string response_unit = "n_m_s2_per_m";

const NamedMethod& method_of(const ResponseOptions& options) {
  if (!options.method) return methods[options.period_samples > 0 ? 0 : 1];
  std::vector<std::string> known;
  for (const auto& method : methods) {
    if (method.name == *options.method) return method;
    known.push_back(method.name);
  }
  throw UserError("--method: " + signals::unknown_name("method", *options.method, known));
}

void check_request(const NamedMethod& method, const std::size_t n_records,
                   const ResponseOptions& options) {
  if (method.needs_period && options.period_samples == 0) {
    throw UserError("--method " + method.name + " averages whole periods: give --period");
  }
  if (!method.needs_period && options.period_samples > 0) {
    throw UserError("--method " + method.name + " takes no --period; leave one of them out");
  }
  const bool takes_several = method.method == ResponseMethod::robust;
  if (takes_several == (n_records == 1)) {
    throw UserError(takes_several
                        ? "--method robust compares realisations: give further records with "
                          "--realisation"
                        : "--realisation: only --method robust takes more than one record");
  }
}

std::vector<double> roots_of(const std::vector<double>& variances) {
  std::vector<double> roots;
  for (const double variance : variances) roots.push_back(std::sqrt(variance));
  return roots;
}

struct Channels {
  explicit Channels(const Record& record)
      : input(record.channel(signals::channel::base_acceleration)),
        output(record.channel(signals::channel::base_moment)),
        rate_hz(record.sampling_rate_hz()) {}
  signals::PeriodAverage average(const std::size_t period_samples) const {
    return signals::average_periods(input, output, rate_hz, period_samples);
  }
  std::span<const double> input, output;
  double rate_hz;
};

MeasuredResponse by_local_polynomial(const Channels& record) {
  auto found = signals::local_polynomial_response(record.input, record.output, record.rate_hz);
  return {{"local polynomial", report::CurveStyle::line, std::move(found.response)},
          {{"noise_power_n2_m2", std::move(found.noise_variance)}},
          {},
          "standard deviation: noise at the output; it does not show the bias from accelerometer "
          "noise, and it counts distortion as noise"};
}

MeasuredResponse by_realisations(const std::vector<Record>& records,
                                 const std::size_t period_samples) {
  std::vector<signals::PeriodAverage> averages;
  for (const auto& record : records) averages.push_back(Channels(record).average(period_samples));
  auto found = signals::robust_approximation(averages);
  return {
      {"best linear approximation, " + std::to_string(found.n_realisations) + " realisations",
       report::CurveStyle::points, std::move(found.response)},
      {{"noise_deviation_" + response_unit, roots_of(found.noise_variance)},
       {"distortion_variance_" + response_unit + "_squared", std::move(found.distortion_variance)}},
      {},
      "standard deviation: of the mean, noise and distortion together; distortion: of one "
      "realisation, an unbiased estimate, so it is below zero at some lines of a linear sensor; "
      "even and odd distortion are not distinguished"};
}

MeasuredResponse by_detection_lines(const Channels& record, const std::size_t period_samples) {
  auto found = signals::fast_approximation(record.average(period_samples));
  const bool odd_known = !found.odd_power.empty();
  MeasuredResponse measured{
      {"best linear approximation", report::CurveStyle::points, std::move(found.response)},
      {{"noise_deviation_" + response_unit, roots_of(found.noise_variance)},
       {"noise_power_n2_m2", std::move(found.noise_power)},
       {"even_distortion_power_n2_m2", std::move(found.even_power)}},
      std::move(found.detection),
      odd_known ? "standard deviation: noise and odd distortion together"
                : "the drive has no odd detection line: odd distortion is not known, and the "
                  "standard deviation is that of noise alone"};
  if (odd_known) {
    measured.evidence.push_back({"odd_distortion_power_n2_m2", std::move(found.odd_power)});
  }
  return measured;
}

}  // namespace

std::string response_method_help() {
  std::string text;
  for (const auto& method : methods) text += "\n  " + method.name + ": " + method.about;
  return text;
}

MeasuredResponse measure_response(const std::vector<Record>& records,
                                  const ResponseOptions& options) {
  const NamedMethod& method = method_of(options);
  check_request(method, records.size(), options);
  const Channels first(records.front());
  switch (method.method) {
    case ResponseMethod::periods:
      return {{"whole periods", report::CurveStyle::points,
               signals::periodic_response(first.input, first.output, first.rate_hz,
                                          options.period_samples)},
              {},
              {},
              "standard deviation: noise; distortion repeats with the period and is not included"};
    case ResponseMethod::welch:
      return {{"Welch", report::CurveStyle::line,
               signals::welch_response(first.input, first.output, first.rate_hz,
                                       {options.segment_samples})},
              {},
              {},
              "standard deviation: from the coherence; it does not show the bias from leakage and "
              "accelerometer noise"};
    case ResponseMethod::local_polynomial:
      return by_local_polynomial(first);
    case ResponseMethod::robust:
      return by_realisations(records, options.period_samples);
    case ResponseMethod::fast:
      break;
  }
  return by_detection_lines(first, options.period_samples);
}

report::Table response_table(const MeasuredResponse& measured) {
  const auto& response = measured.curve.response;
  const auto figure = views::bode_figure({measured.curve});
  std::vector<ResponseEvidence> columns = {
      {"frequency_hz", response.frequency_hz},
      {"magnitude_" + response_unit, figure.panels[0].curves[0].y},
      {"phase_deg", figure.panels[1].curves[0].y}};
  if (!response.standard_deviation.empty()) {
    columns.push_back({"standard_deviation_" + response_unit, response.standard_deviation});
  }
  if (!response.coherence.empty()) columns.push_back({"coherence", response.coherence});
  columns.insert(columns.end(), measured.evidence.begin(), measured.evidence.end());
  std::vector<report::Column> headings;
  for (const auto& column : columns) headings.push_back({column.name, ""});
  report::Table table(headings);
  for (std::size_t i = 0; i < response.frequency_hz.size(); ++i) {
    std::vector<report::Cell> row;
    for (const auto& column : columns) row.emplace_back(column.values[i]);
    table.add_row(row);
  }
  return table;
}

report::Table detection_table(const std::vector<signals::DetectedOutput>& detection) {
  report::Table table(
      {{"frequency_hz", ""}, {"role", ""}, {"power_n2_m2", ""}, {"noise_power_n2_m2", ""}});
  for (const auto& line : detection) {
    table.add_row({line.frequency_hz, signals::name_of(line.role), line.power, line.noise_power});
  }
  return table;
}

nlohmann::json response_json(const MeasuredResponse& measured) {
  const auto& response = measured.curve.response;
  nlohmann::json points = nlohmann::json::array(), detection = nlohmann::json::array();
  for (std::size_t i = 0; i < response.frequency_hz.size(); ++i) {
    nlohmann::json point{{"frequency_hz", response.frequency_hz[i]},
                         {"real", response.value[i].real()},
                         {"imaginary", response.value[i].imag()}};
    if (!response.coherence.empty()) point["coherence"] = response.coherence[i];
    if (!response.standard_deviation.empty()) {
      point["standard_deviation"] = response.standard_deviation[i];
    }
    for (const auto& [name, values] : measured.evidence) {
      point[name] = report::json_or_null(values[i]);
    }
    points.push_back(point);
  }
  for (const auto& line : measured.detection) {
    detection.push_back({{"frequency_hz", line.frequency_hz},
                         {"role", signals::name_of(line.role)},
                         {"power_n2_m2", line.power},
                         {"noise_power_n2_m2", line.noise_power}});
  }
  nlohmann::json document{{"unit", "N m s^2/m"}, {"convention", "exp(+j w t)"}, {"points", points}};
  if (!measured.detection.empty()) document["detection"] = detection;
  if (!measured.words.empty()) document["words"] = measured.words;
  return document;
}

}  // namespace vibrissa::apps
