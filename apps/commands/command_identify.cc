#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "apps/command_line/results.h"
#include "apps/jobs/fault_warnings.h"
#include "report/files/run_folder.h"
#include "separation/identification/identify.h"
#include "separation/identification/identify_response.h"
#include "separation/identification/output_only.h"
#include "separation/model/c_header.h"
#include "separation/model/sampled_bvrm.h"
#include "separation/nonlinear/identify_nonlinear.h"
#include "separation/nonlinear/nonlinear_c_header.h"
#include "separation/ringdown/ring_down.h"
#include "separation/segments/hit_blocks.h"
#include "signals/base/error.h"
#include "signals/files/response_file.h"
#include "views/records/identification_report.h"
#include "views/records/nonlinear_report.h"
#include "views/records/ring_down_plots.h"

namespace vibrissa::apps {

namespace {

/// Beyond it nothing is told apart, and trying takes hours.
constexpr int highest_order = 40;

struct IdentifyCommandOptions {
  const CLI::App* command = nullptr;
  CommonOptions common;
  RecordOptions record;
  std::string record_file;
  std::optional<std::string> held_out_file, model_file, c_header_file;
  separation::IdentifyOptions identify;
  std::optional<std::string> hold;
  std::string method = "output-error";
  bool no_direct_term = false, cross_validation = false, output_only = false, ring_down = false;
  bool nonlinear = false;
  std::optional<std::size_t> max_lags;
  bool frequency_response = false;
  std::string response_as;
};

/// Those that only a record of acceleration and moment has a use for.
const std::vector<std::string>& options_of_records() {
  static const std::vector<std::string> names = {"--held-out",         "--c-header", "--hold",
                                                 "--cross-validation", "--period",   "--method",
                                                 "--nonlinear"};
  return names;
}

/// The model is written unless only JSON was asked for.
std::optional<std::string> model_file_of(const IdentifyCommandOptions& options) {
  if (options.common.json && !options.model_file) return std::nullopt;
  return given_or_result(options.model_file, "identify", "bvrm.json");
}

void say_written(const IdentifyCommandOptions& options, const std::optional<std::string>& file) {
  if (file && !options.common.quiet) std::cout << "model: " << *file << "\n";
}

void refuse_what_needs_an_input(const CLI::App& command, const std::string& given) {
  const std::string reason = "needs the base acceleration; " + given + " does not use it";
  refuse_given(command, options_of_records(), reason);
  refuse_given(command, {"--no-direct-term", "--frequency-response", "--response-as"}, reason);
}

void refuse_what_needs_a_record(const CLI::App& command) {
  const std::string reason = "is for records; --frequency-response reads none";
  refuse_given(command, options_of_records(), reason);
  refuse_given(command, record_option_names(), reason);
}

void refuse_unused(const CLI::App& command, const IdentifyCommandOptions& options) {
  if (!options.output_only) refuse_given(command, {"--lags"}, "is for --output-only");
  if (options.identify.order && !options.output_only)
    refuse_given(command, {"--max-order", "--cross-validation"},
                 "chooses an order, and --order states it");
}

void identify_from_response(const IdentifyCommandOptions& options) {
  refuse_what_needs_a_record(*options.command);
  const signals::formats::FileResponse response =
      read_said_response(options.record_file, options.response_as, options.common);
  if (response.coherence.empty() && response.standard_deviation.empty())
    std::cerr << "warning: " << options.record_file
              << ": the file has no coherence and no standard deviation, so every line has the "
                 "same weight, also where nothing was excited\n";
  const auto found =
      separation::identify_response(response, {.order = options.identify.order,
                                               .max_order = options.identify.max_order,
                                               .direct_term = !options.no_direct_term});
  const bool is_moment = response.unit == signals::formats::moment_per_acceleration;
  const std::optional<std::string> model_file = is_moment ? model_file_of(options) : std::nullopt;
  const separation::Verdict verdict = separation::judge(found, response);
  if (model_file)
    separation::write_bvrm(*model_file, {found.fit.model, std::nullopt, verdict.stated()});
  if (!is_moment)
    std::cerr << "warning: no model is written: its gains would be in " << response.unit << "\n";
  const std::string gain_unit = is_moment ? separation::moment_gain_unit : response.unit;
  if (options.common.json) {
    print_json(separation::identified_response_json(found, verdict, gain_unit));
    return;
  }
  std::cout << views::verdict_text(found.fit, verdict, gain_unit) << "direct term "
            << found.fit.direct_term_kg_m.value << " " << gain_unit << "; order " << found.order
            << ", " << response.value.size() << " lines from " << response.frequency_hz.front()
            << " to " << response.frequency_hz.back() << " Hz, "
            << separation::to_string(found.fit.end)
            << "\nfit of every third line by a model of the others: " << found.held_out_fit_percent
            << " %\n"
            << (found.order_words.empty() ? "" : "order: " + found.order_words + "\n");
  say_written(options, model_file);
}

void identify_from_output(const IdentifyCommandOptions& options) {
  refuse_what_needs_an_input(*options.command, "--output-only");
  refuse_given(*options.command, {"-o"},
               "is for a model, which needs the base acceleration; --output-only does not use it");
  refuse_given(*options.command, {"--ring-down"}, "and --output-only are two ways; give one");
  refuse_given(*options.command, {"--max-order"},
               "is not used by --output-only, whose highest is --order");
  std::string unit;
  const signals::Record record = options.record.read_in_own_unit(options.record_file, unit);
  separation::OutputOnlyOptions output_only;
  output_only.max_lags = options.max_lags;
  if (options.identify.order) output_only.max_order = *options.identify.order;
  const auto found = separation::identify_output_only(record.channel(signals::channel::base_moment),
                                                      record.sampling_rate_hz(), output_only);
  if (options.common.json) {
    print_json(separation::output_only_json(found));
    return;
  }
  std::cout << views::output_only_table(found).to_text() << found.words << "\n";
}

void write_ring_down(const report::RunFolder& folder, const separation::RingDown& found,
                     const report::Figure& figure) {
  folder.write_run({.command_line = given_command_line()});
  folder.write_json("ring_down.json", separation::ring_down_json(found));
  folder.write_text("ring_down.csv", views::ring_down_table(found).to_csv());
  report::write_figure(folder.path(), figure);
}

void identify_from_decay(const IdentifyCommandOptions& options) {
  refuse_what_needs_an_input(*options.command, "--ring-down");
  refuse_given(*options.command, {"--order", "--max-order"}, "is not used by --ring-down");
  const std::optional<std::filesystem::path> told = options.model_file;
  report::RunFolder::refuse_taken(told);
  std::string unit;
  const signals::Record record = options.record.read_in_own_unit(options.record_file, unit);
  const auto& moment = record.channel(signals::channel::base_moment);
  const auto found = separation::identify_ring_down(moment, record.sampling_rate_hz(), unit);
  if (options.common.json)
    print_json(separation::ring_down_json(found));
  else
    std::cout
        << found.words << "\n"
        << views::ring_down_table(found).to_text()
        << "law: one law fitted to all samples; without a law: damped sines, a few periods each; "
           "amplitude: peak of the moment; sd: standard deviation\n"
           "drag: damping that grows with the speed squared; friction: sticks before it slips "
           "(docs/nonlinear.md)\n";
  if (options.common.json && !told) return;
  const auto folder = report::RunFolder::given_or_free(told, "results/ring-down");
  write_ring_down(folder, found, views::ring_down_figure(found, moment, record.sampling_rate_hz()));
  const auto pictures = draw_pictures(folder.path());
  if (options.common.is_talkative())
    std::cout << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

void say_identified(const IdentifyCommandOptions& options, const separation::Identification& result,
                    const separation::ModelEvidence& evidence, const bool scored_by_piece) {
  std::cout << views::verdict_text(result.fit, evidence.verdict) << "direct term "
            << result.fit.direct_term_kg_m.value << " kg m"
            << (result.direct_term ? "" : " (not told from zero)") << "; order " << result.order
            << ", " << separation::to_string(result.hold) << " input, "
            << separation::to_string(result.fit.end)
            << "\nfit on held-out data, free simulation: " << result.held_out_fit_percent << " % ("
            << result.held_out_vaf_percent << " % of the variance)\n"
            << (result.order_words.empty() ? "" : "order: " + result.order_words + "\n")
            << (result.scatter_words.empty() ? "" : result.scatter_words + "\n")
            << views::evidence_text(evidence);
  if (options.common.quiet) return;
  if (scored_by_piece)
    std::cout << "Held out: the longest other piece of the file with a hit scored the model.\n";
  else if (!options.held_out_file)
    std::cout << "Held out: the last "
              << (result.n_hits > 1 ? "of " + std::to_string(result.n_hits) + " hits" : "third")
              << " of the record scored a model of the rest; the model above is of the whole "
                 "record.\n";
}

void offer_output_only(const signals::Record& record, const std::string& file) {
  const std::string& input = signals::channel::base_acceleration;
  if (record.has(input) || !record.has(signals::channel::base_moment)) return;
  throw signals::UserError(
      file + ": no column " + input +
      ": name it (--column 'base_acceleration=NAME[unit]'); if it was not "
      "measured, 'vibrissa identify " +
      file +
      " --output-only' gives resonances and damping from the moment alone, and "
      "--ring-down, after flicks or hits, gives them against the amplitude");
}

signals::Record read_checked(const IdentifyCommandOptions& options, signals::Recording& others) {
  others = options.record.read_pieces(options.record_file);
  signals::Record record = RecordOptions::take_longest(options.record_file, others);
  offer_output_only(record, options.record_file);
  warn_of_faults(options.record_file, record);
  return record;
}

std::size_t n_hits(const signals::Record& record) {
  return separation::hits_of(record.channel(signals::channel::base_acceleration)).size();
}

/// The longest other piece of the file with a hit, where the record has no second hit to score the
/// model.
std::optional<signals::Record> piece_that_scores(const signals::Record& record,
                                                 const signals::Recording& others) {
  const signals::Record* best = nullptr;
  if (n_hits(record) == 1)
    for (const signals::Record& piece : others.pieces)
      if (n_hits(piece) > 0 && (!best || piece.n_samples() > best->n_samples())) best = &piece;
  return best ? std::optional(*best) : std::nullopt;
}

separation::IdentifyOptions identify_options(const IdentifyCommandOptions& options) {
  separation::IdentifyOptions identify = options.identify;
  identify.method = separation::parse_identify_method(options.method);
  if (options.hold) identify.hold = separation::parse_hold(*options.hold);
  identify.direct_term = !options.no_direct_term;
  if (options.cross_validation) identify.order_rule = separation::OrderRule::cross_validation;
  return identify;
}

void identify_with_law(const IdentifyCommandOptions& options) {
  refuse_given(*options.command, {"--method"}, "is not used by --nonlinear, an output-error fit");
  signals::Recording others;
  const signals::Record record = read_checked(options, others);
  std::optional<signals::Record> held_out;
  if (options.held_out_file) held_out = options.record.read(*options.held_out_file);
  const auto found = separation::identify_nonlinear(record, held_out, identify_options(options));
  const separation::NonlinearBvrm& model = found.fit.model;
  // The header comes first: it may be refused, and then nothing has been written.
  if (options.c_header_file)
    separation::write_nonlinear_c_header(*options.c_header_file, model,
                                         {record.sampling_rate_hz(), model.hold_or({})});
  const std::optional<std::string> model_file = model_file_of(options);
  if (model_file && found.has_law()) separation::write_nonlinear_bvrm(*model_file, model);
  if (model_file && !found.has_law())
    separation::write_bvrm(*model_file, {model.linear, model.hold});
  if (options.common.json) {
    print_json(separation::nonlinear_report(found));
    return;
  }
  std::cout << views::nonlinear_text(found);
  say_written(options, model_file);
}

void identify(const IdentifyCommandOptions& options) {
  signals::Recording others;
  const signals::Record all = read_checked(options, others);
  const separation::IdentifyOptions identify = identify_options(options);
  const std::optional<signals::Record> scoring = options.held_out_file
                                                     ? options.record.read(*options.held_out_file)
                                                     : piece_that_scores(all, others);
  // Without it the last third scores the model, then the model is fitted to all.
  const auto [fit, held_out] =
      scoring ? separation::SplitRecord{all, *scoring} : separation::hold_out_part(all);
  auto result = scoring ? separation::identify_bvrm(fit, held_out, identify)
                        : separation::identify_record(all, identify);
  const bool is_scored_by_piece = scoring && !options.held_out_file;
  if (is_scored_by_piece) result.n_hits = n_hits(all) + n_hits(*scoring);
  const separation::ModelEvidence evidence = separation::examine(result, fit, held_out);
  // The header comes first: it may be refused, and then nothing has been written.
  if (options.c_header_file) {
    separation::write_c_header(*options.c_header_file, result.fit.model,
                               {all.sampling_rate_hz(), result.hold});
  }
  const std::optional<std::string> model_file = model_file_of(options);
  if (model_file)
    separation::write_bvrm(*model_file, {result.fit.model, result.hold, evidence.verdict.stated()});
  if (options.common.json) {
    print_json(separation::identification_report(result, evidence, options.method));
    return;
  }
  say_identified(options, result, evidence, is_scored_by_piece);
  say_written(options, model_file);
}

void add_other_inputs(CLI::App& command, IdentifyCommandOptions& options) {
  command.add_flag(
      "--output-only", options.output_only,
      "Gives resonances and damping from base_moment alone, after a hit or under an input that was "
      "not measured and is close to white noise; gives no gain and no model. --order is then the "
      "highest order tried (default 20); --max-order is not used");
  command.add_flag(
      "--ring-down", options.ring_down,
      "The base_moment decays after flicks or hits: gives frequency and damping against the "
      "amplitude, and the law of the damping (viscous, drag, friction), with a picture; gives no "
      "gain and no model, so -o is a new folder (default: results/ring-down, or "
      "results/ring-down-2, ... if it exists; with --json only if -o is given)");
  command
      .add_option("--lags", options.max_lags,
                  "For --output-only: half of the longest lag of the covariances [samples], which "
                  "should cover a few periods of the lowest resonance (default: from the data)")
      ->check(positive_number());
  command.add_flag("--frequency-response", options.frequency_response,
                   "The file holds a measured frequency response base acceleration -> base "
                   "moment: a Universal File (function of type 4), a .mat or a CSV");
  command.add_option("--response-as", options.response_as,
                     "For --frequency-response: name, unit and factor of the response, "
                     "NAME[unit]*FACTOR[unit], e.g. 'H[mN mm/g]' or '[uT/g]*0.18[N m/T]'; in a "
                     "Universal File with several responses NAME is the number of one");
}

void identify_what_is_given(IdentifyCommandOptions options) {
  refuse_overwriting({options.record_file, options.held_out_file},
                     {options.model_file, options.c_header_file});
  refuse_unused(*options.command, options);
  if (!options.response_as.empty()) options.frequency_response = true;
  if (options.output_only)
    identify_from_output(options);
  else if (options.ring_down)
    identify_from_decay(options);
  else if (options.frequency_response)
    identify_from_response(options);
  else if (options.nonlinear)
    identify_with_law(options);
  else
    identify(options);
}

}  // namespace

void add_identify_command(CLI::App& app) {
  const auto options = std::make_shared<IdentifyCommandOptions>();
  auto* command = app.add_subcommand("identify",
                                     "Identifies the base vibration response model (BVRM) from a "
                                     "record of base acceleration and moment");
  options->command = command;
  command->add_option("record", options->record_file, "Record, or frequency response")->required();
  command->add_option(
      "--held-out", options->held_out_file,
      "Record that only scores the model and is not fitted (default: last third of the record)");
  command
      ->add_option("--order", options->identify.order,
                   "Number of poles, two for each mode, so an even number (default: chosen by "
                   "information criterion)")
      ->check(CLI::Range(1, highest_order));
  command
      ->add_option("--max-order", options->identify.max_order,
                   "Highest number of poles tried (2, 4, ...), above 6 while unseen data gain")
      ->check(CLI::Range(1, highest_order))
      ->capture_default_str();
  command->add_flag("--cross-validation", options->cross_validation,
                    "Chooses the order by a part of the fit record; --held-out is not used for it");
  command
      ->add_option("--period", options->identify.period_samples,
                   "Period of a periodic record [samples]")
      ->check(not_negative_number());
  command->add_option("--hold", options->hold,
                      "Input between samples: first_order, zero_order or band_limited (default: "
                      "the one that fits best)");
  command->add_flag("--no-direct-term", options->no_direct_term,
                    "Leaves out the direct term (strictly proper model)");
  command
      ->add_option("--method", options->method,
                   "output-error; srivc, refined instrumental variables; or frequency, the fit of "
                   "the frequency response (of whole periods with --period, else Welch's)")
      ->capture_default_str();
  command->add_flag("--nonlinear", options->nonlinear,
                    "Also fits the law of the joint that the record asks for: cubic or quadratic "
                    "stiffness, quadratic damping, friction, else a polynomial in deflection and "
                    "velocity; each term must lower the error on data that no fit has seen");
  add_other_inputs(*command, *options);
  command->add_option(
      "-o,--output,--out", options->model_file,
      "File for the model as JSON (default: results/identify/bvrm.json, or "
      "results/identify-2/, ... if it exists; with --json only if this option is given)");
  command->add_option(
      "--c-header", options->c_header_file,
      "Also writes the model as C header for a microcontroller, at the record's sampling rate");
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa identify bench.csv --column 'base_acceleration=ax[g]' -o bvrm.json\n"
      "  vibrissa identify bench.csv --method srivc --hold first_order --c-header bvrm.h\n"
      "  vibrissa identify modal_test.uff --frequency-response --response-as '2[mN mm/g]'\n      "
      "(the second response of the file, in mN mm/g)\n"
      "  vibrissa identify loud.csv --nonlinear -o nonlinear.json\n"
      "  vibrissa identify flick.csv --ring-down\n"
      "  vibrissa identify bridge.csv --output-only");
  command->callback([options] { identify_what_is_given(*options); });
}

}  // namespace vibrissa::apps
