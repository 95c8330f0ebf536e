#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "apps/command_line/results.h"
#include "apps/jobs/fault_warnings.h"
#include "apps/jobs/model_advice.h"
#include "apps/jobs/stream_separation.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/prediction/record_simulation.h"
#include "separation/filters/bvrm_separator.h"
#include "separation/filters/fdaf.h"
#include "separation/metrics/wind_speed.h"
#include "separation/model/sampled_bvrm.h"
#include "separation/nonlinear/nonlinear_separator.h"
#include "separation/stream_methods.h"
#include "signals/base/error.h"
#include "signals/files/file_format.h"
#include "signals/files/record_io.h"
#include "signals/model/reduced_model.h"
#include "signals/system/output_file.h"
#include "views/records/separation_scores.h"

namespace vibrissa::apps {

namespace {

struct SeparateOptions {
  const CLI::App* command = nullptr;
  CommonOptions common;
  RecordOptions record;
  std::string record_file;
  std::optional<std::string> model_file, truth_column, output_file, dtw_path_file;
  std::optional<std::string> hold;
  separation::FdafOptions fdaf = {64, 512, {}, {}, 0.};
  std::vector<std::string> methods = {"fdaf"};
  std::optional<std::string> sensor_model_file;
  double moment_deviation_n_m = 1e-6;
  double settling_s = 2.;
  bool stream = false;
};

/// The base acceleration between its samples as told, else as the model's fit took it.
template <typename Model>
separation::Hold hold_of(const SeparateOptions& options, const Model& model) {
  std::optional<separation::Hold> told;
  if (options.hold) told = separation::parse_hold(*options.hold);
  const separation::Hold hold = model.hold_or(told);
  if (model.hold && hold != *model.hold && !options.common.quiet)
    std::cerr << "vibrissa: " << *options.model_file << " was fitted to a "
              << to_string(*model.hold) << " base acceleration, but --hold says " << to_string(hold)
              << "\n";
  return hold;
}

std::unique_ptr<separation::Separator> bvrm_separator(const SeparateOptions& options,
                                                      const double sampling_rate_hz) {
  if (separation::is_nonlinear_bvrm(*options.model_file)) {
    const auto model = separation::read_nonlinear_bvrm(*options.model_file);
    return std::make_unique<separation::NonlinearSeparator>(model, sampling_rate_hz,
                                                            hold_of(options, model));
  }
  const separation::SampledBvrm bvrm = separation::read_bvrm(*options.model_file);
  if (const std::string warning = bvrm.warning(); !warning.empty())
    std::cerr << "warning: " << *options.model_file << ": " << warning << "\n";
  return std::make_unique<separation::BvrmSeparator>(bvrm.model, sampling_rate_hz,
                                                     hold_of(options, bvrm));
}

/// aligned: the record for filters that only know the past.
std::vector<views::SeparatedSignal> separate_all(const SeparateOptions& options,
                                                 const signals::Record& record,
                                                 const signals::Record& aligned,
                                                 const std::vector<double>& truth) {
  const auto measured = record.channel(signals::channel::base_moment);
  std::vector<views::SeparatedSignal> signals{views::score(
      "nothing removed", {measured.begin(), measured.end()}, record, truth, options.settling_s)};
  if (options.model_file && diagnosis::is_updated_model(*options.model_file)) {
    signals.push_back(views::score(
        "updated_model",
        diagnosis::subtract_vibration(diagnosis::read_updated_model(*options.model_file), record),
        record, truth, options.settling_s));
  } else if (options.model_file) {
    const auto bvrm = bvrm_separator(options, record.sampling_rate_hz());
    signals.push_back(views::score("bvrm", separation::separate_record(*bvrm, record), record,
                                   truth, options.settling_s));
  }
  for (const auto& name : options.methods) {
    const auto separator = separation::stream_method(name).make(options.fdaf);
    signals.push_back(views::score(name, separation::separate_record(*separator, aligned), record,
                                   truth, options.settling_s));
  }
  return signals;
}

signals::Record output_record(const signals::Record& record,
                              const std::vector<views::SeparatedSignal>& signals) {
  signals::Record output(record.sampling_rate_hz(), record.n_samples(), record.time_s(0));
  for (const auto& name : record.channel_names()) {
    const auto values = record.channel(name);
    output.set_channel(name, {values.begin(), values.end()});
  }
  for (const auto& signal : signals) {
    if (signal.name == "nothing removed") continue;
    output.set_channel("wind_moment_" + signal.name + "_N_m", signal.wind_moment_n_m);
  }
  return output;
}

constexpr double fastest_wind_m_s = 30.;

// Adds the speed of the wind and the ends of its interval for each method, by the sensor model's
// steady drag.
void add_wind_speeds(const SeparateOptions& options,
                     const std::vector<views::SeparatedSignal>& signals, signals::Record& output) {
  const auto model = signals::read_reduced_model(*options.sensor_model_file);
  const separation::DragCalibration calibration(
      [&model](const double speed) { return signals::steady_wind_moment(model, speed); },
      fastest_wind_m_s);
  for (const auto& signal : signals) {
    if (signal.name == "nothing removed") continue;
    std::vector<double> value, low, high;
    for (const auto& speed : separation::wind_speed(calibration, signal.wind_moment_n_m,
                                                    options.moment_deviation_n_m)) {
      value.push_back(speed.value_m_s);
      low.push_back(speed.low_m_s);
      high.push_back(speed.high_m_s);
    }
    output.set_channel("wind_speed_" + signal.name + "_m_s", std::move(value));
    output.set_channel("wind_speed_low_" + signal.name + "_m_s", std::move(low));
    output.set_channel("wind_speed_high_" + signal.name + "_m_s", std::move(high));
  }
}

void separate_as_stream(const SeparateOptions& options) {
  if (options.truth_column || options.dtw_path_file || options.sensor_model_file)
    throw signals::UserError(
        "--stream holds no record, which --truth, --dtw-path and --sensor-model need; leave "
        "--stream or these options out");
  if (options.output_file && signals::formats::extension_of(*options.output_file) != ".csv")
    throw signals::UserError("--stream writes CSV: give -o a name that ends in .csv");
  if (options.model_file && diagnosis::is_updated_model(*options.model_file))
    throw signals::UserError(*options.model_file +
                             ": an updated model needs the whole record: leave --stream out, or "
                             "give a model of 'vibrissa identify'");
  options.record.refuse_unused(options.record_file);
  signals::RecordStream record(options.record_file, options.record.read_options());
  std::vector<NamedSeparator> methods;
  if (options.model_file)
    methods.push_back({"bvrm", bvrm_separator(options, record.sampling_rate_hz())});
  for (const auto& name : options.methods)
    methods.push_back({name, separation::stream_method(name).make(options.fdaf)});
  const std::string output = given_or_result(options.output_file, "separate", "separated.csv");
  separate_stream(record, methods, output, options.common.is_talkative());
  if (options.common.json)
    print_json({{"record", output}, {"samples", record.n_samples()}});
  else if (!options.common.quiet)
    std::cout << "wrote " << output << ": " << record.n_samples() << " samples\n";
}

/// The record is written unless only JSON was asked for.
std::optional<std::string> written_file(const SeparateOptions& options) {
  if (options.common.json && !options.output_file && !options.sensor_model_file)
    return std::nullopt;
  return given_or_result(options.output_file, "separate", "separated.csv");
}

bool uses_any(const SeparateOptions& options, const std::vector<std::string>& methods) {
  return std::ranges::any_of(options.methods, [&](const std::string& name) {
    return std::ranges::count(methods, name) > 0;
  });
}

void refuse_unused(const SeparateOptions& options) {
  const CLI::App& command = *options.command;
  if (!options.model_file || diagnosis::is_updated_model(*options.model_file))
    refuse_given(command, {"--hold"}, "needs --model with a model of 'vibrissa identify'");
  if (!uses_any(options, {"fdaf", "kalman"}))
    refuse_given(command, {"--block"}, "needs --method fdaf or kalman");
  if (!uses_any(options, {"fdaf", "kalman", "nlms"}))
    refuse_given(command, {"--taps"}, "needs --method fdaf, kalman or nlms");
  if (!uses_any(options, {"fdaf"})) refuse_given(command, {"--step"}, "needs --method fdaf");
  if (!options.sensor_model_file)
    refuse_given(command, {"--moment-deviation"}, "needs --sensor-model");
  if (options.stream) {
    refuse_given(command, {"--settling"}, "is for scores, which --stream does not give");
    if (options.record.gaps == "pieces")
      refuse_given(command, {"--gaps"}, "pieces needs the whole record, and --stream refuses gaps");
  }
  if (options.record.join)
    refuse_given(command, {"--truth", "--stream"},
                 "reads one file: join the files first by 'vibrissa convert --join'");
}

void separate(const SeparateOptions& options) {
  refuse_unused(options);
  refuse_overwriting({options.record_file, options.model_file, options.sensor_model_file},
                     {options.output_file, options.dtw_path_file});
  if (options.stream) return separate_as_stream(options);
  if (options.dtw_path_file && !options.truth_column) {
    throw signals::UserError(
        "--dtw-path compares with the true wind moment: name its column (--truth)");
  }
  const signals::Record record = options.record.read(options.record_file);
  warn_of_faults(options.record_file, record);
  std::vector<double> truth;
  if (options.truth_column) {
    truth = options.record.read_column(options.record_file, *options.truth_column);
  }
  const auto advice = options.model_file ? std::nullopt : model_advice(record);
  const auto signals =
      separate_all(options, record, advice ? without_lead(record, *advice) : record, truth);
  const std::string advised =
      advice ? advice_words(*advice, signals, record.sampling_rate_hz()) : "";
  if (options.dtw_path_file) {
    const auto table = views::warping_table(signals, record, truth, options.settling_s);
    signals::write_file(*options.dtw_path_file, [&](std::ostream& out) { out << table.to_csv(); });
  }
  const std::optional<std::string> output_file = written_file(options);
  if (output_file) {
    signals::Record output = output_record(record, signals);
    if (options.sensor_model_file) add_wind_speeds(options, signals, output);
    signals::write_record(*output_file, output);
  }
  if (options.common.json) {
    nlohmann::json document = views::separation_json(signals);
    if (!advised.empty()) document["advice"] = advised;
    print_json(document);
    return;
  }
  if (output_file && !options.common.quiet) std::cout << written_record_text(*output_file, record);
  const bool is_blind = !options.truth_column;
  std::cout
      << (is_blind ? views::blind_separation_table : views::separation_table)(signals).to_text();
  if (!options.common.quiet)
    std::cout << (is_blind ? views::blind_metric_notes : views::metric_notes)(options.settling_s)
              << "\n";
  if (!advised.empty()) std::cout << "Advice: " << advised << ".\n";
}

void add_filter_options(CLI::App& command, SeparateOptions& options) {
  command
      .add_option("--block", options.fdaf.block_length,
                  "Block of the adaptive filter (fdaf, kalman) [samples]")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command
      .add_option("--taps", options.fdaf.filter_length,
                  "Length of the adaptive filter (fdaf, kalman, nlms) [samples]")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  command
      .add_option("--step", options.fdaf.step.step, "Step size mu of the adaptive filter (fdaf)")
      ->capture_default_str();
}

}  // namespace

void add_separate_command(CLI::App& app) {
  const auto options = std::make_shared<SeparateOptions>();
  auto* command = app.add_subcommand(
      "separate",
      "Separates the wind part of a record's base moment, by a BVRM or by an adaptive filter");
  options->command = command;
  command
      ->add_option(
          "record", options->record_file,
          "Record with base moment, and base acceleration for all methods but line_canceller")
      ->required();
  command->add_option(
      "--model", options->model_file,
      "BVRM (JSON, from 'vibrissa identify', linear or nonlinear) or updated_model.json of a "
      "diagnosis "
      "(without it: adaptive filter only)");
  command->add_option("--hold", options->hold,
                      "Base acceleration between samples: first_order, zero_order or band_limited "
                      "(default: as the model was fitted, else first_order)");
  std::string known;
  for (const auto& method : separation::stream_methods())
    known += "\n  " + method.name + ": " + method.about;
  command
      ->add_option(
          "--method", options->methods,
          "Methods that need no model; they run beside that of --model (may be repeated):" + known)
      ->capture_default_str();
  command->add_option("--sensor-model", options->sensor_model_file,
                      "Reduced model of the sensor (model.json of 'vibrissa run'); adds a "
                      "wind-speed column, computed from its steady drag");
  command
      ->add_option("--moment-deviation", options->moment_deviation_n_m,
                   "Standard error of the separated moment [N m] (not the size of the signal); it "
                   "sets the confidence interval of the wind speed")
      ->check(not_negative_number())
      ->capture_default_str();
  command->add_option("--truth", options->truth_column,
                      "Column with the true wind moment [N m], for the scores");
  command->add_option("--dtw-path", options->dtw_path_file,
                      "Also writes the time-warping path of the DTW score as CSV: time of the "
                      "truth, time of the estimate");
  command->add_option("-o,--output,--out", options->output_file,
                      "File for the record with a wind moment for each method (default: "
                      "results/separate/separated.csv, or results/separate-2/, ... if it exists; "
                      "with --json only if this option is given)");
  add_filter_options(*command, *options);
  command
      ->add_option("--settling", options->settling_s,
                   "Time at the start that the scores leave out [s]")
      ->check(not_negative_number())
      ->capture_default_str();
  command->add_flag("--stream", options->stream,
                    "Reads and writes (CSV) block by block, for records of any length; gives no "
                    "scores, and cannot be used with --remove-mean");
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa separate bench.csv --model bvrm.json -o wind.csv\n"
      "  vibrissa separate bench.csv --method kalman --method fdaf --taps 400 -o wind.csv\n"
      "  vibrissa separate long.csv --model bvrm.json --stream -o wind.csv");
  command->callback([options] { separate(*options); });
}

}  // namespace vibrissa::apps
