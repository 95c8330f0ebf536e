#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/programs.h"
#include "apps/command_line/record_options.h"
#include "checks/report_json.h"
#include "checks/report_text.h"
#include "diagnosis/diagnosis.h"
#include "report/files/run_folder.h"
#include "signals/base/error.h"
#include "views/records/check_page.h"

namespace vibrissa::apps {
namespace {

struct CheckCommand {
  CommonOptions common;
  RecordOptions record;
  std::vector<std::string> sources;
  std::optional<std::filesystem::path> folder;
};

checks::CheckResult check_source(const CheckCommand& options, const std::string& source) {
  options.record.refuse_unused(source);
  if (!options.record.join) return checks::check_file(source, options.record.read_options());
  const signals::Recording recording = options.record.read_pieces(source);
  return checks::check_one(source, recording.pieces[recording.longest()], recording.words);
}

void write_results(const CheckCommand& options, const std::vector<checks::CheckResult>& results) {
  const report::RunFolder folder(*options.folder);
  folder.write_run({.command_line = given_command_line()});
  folder.write_json("check.json", checks::check_json(results));
  std::string text;
  for (const checks::CheckResult& result : results) text += checks::check_text(result);
  folder.write_text("check.txt", text);
  for (const report::Figure& figure : views::check_plots(results))
    report::write_figure(folder.path(), figure);
  const auto pictures = draw_pictures(folder.path());
  report::write_page(folder.path(), views::check_page(results));
  if (options.common.is_talkative())
    std::cout << pictures.message << "\nResults: " << folder.path().string() << "\n";
}

/// Each command that cannot work, for the message that ends the program.
std::string refusals(const std::vector<checks::CheckResult>& results) {
  std::string text;
  for (const checks::CheckResult& result : results)
    for (const checks::CommandVerdict& verdict : result.serves)
      if (verdict.serves == checks::Serves::no)
        text += (text.empty() ? "" : ", ") + std::string("'") + verdict.command + "' of " +
                result.source;
  return text;
}

/// Columns that only lack a name need no new recording.
std::string advice(const std::vector<checks::CheckResult>& results) {
  const auto lacks_names = [](const checks::CheckResult& result) {
    return checks::only_names_are_missing(result.records);
  };
  return std::ranges::all_of(results, lacks_names)
             ? "; no column is named as a channel: say which is which by --column, as the lines "
               "above show"
             : "; the table says what to record instead";
}

void check(const CheckCommand& options) {
  report::RunFolder::refuse_taken(options.folder);
  std::vector<checks::CheckResult> results;
  for (const std::string& source : options.sources)
    results.push_back(check_source(options, source));
  if (options.common.json)
    print_json(checks::check_json(results));
  else
    for (const checks::CheckResult& result : results) std::cout << checks::check_text(result);
  if (options.folder) write_results(options, results);
  if (const std::string text = refusals(results); !text.empty())
    throw diagnosis::TooLittleData("cannot work with these data: " + text + advice(results));
}

}  // namespace

void add_check_command(CLI::App& app) {
  const auto options = std::make_shared<CheckCommand>();
  auto* command = app.add_subcommand(
      "check",
      "Says what a recording is, what is wrong with it, and which of identify, separate, diagnose "
      "and plan it serves");
  command
      ->add_option("sources", options->sources,
                   "Records, folders of records, or their dataset.json")
      ->required();
  options->record.add_to(*command);
  command->add_option("-o,--out,--output", options->folder,
                      "New folder for report.html, check.json, check.txt and pictures (default: "
                      "nothing is written)");
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa check bench.csv --column 'base_acceleration=ax[g]' \\\n"
      "    --column 'base_moment=hall[uT]*0.18[N m/T]'\n"
      "  vibrissa check bench/dataset.json --out checked\n"
      "Exit status: 0 every command could work, 2 bad input, 3 at least one command cannot work "
      "with these data.");
  command->callback([options] { check(*options); });
}

}  // namespace vibrissa::apps
