#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "signals/base/error.h"
#include "signals/files/file_format.h"
#include "signals/files/record_io.h"
#include "signals/files/response_file.h"
#include "signals/formats/mat_file.h"

namespace vibrissa::apps {
namespace {

struct ConvertOptions {
  const CLI::App* command = nullptr;
  CommonOptions common;
  RecordOptions record;
  std::string from, to;
  std::string mat_version = "5";
  bool frequency_response = false;
  std::string response_as;
};

void convert_response(const ConvertOptions& options) {
  const std::string reason = "is for records; --frequency-response reads none";
  refuse_given(*options.command, {"--mat-version"}, reason);
  refuse_given(*options.command, record_option_names(), reason);
  const auto response = read_said_response(options.from, options.response_as, options.common);
  signals::formats::write_response(
      options.to, response, std::filesystem::path(options.from).stem().string(), response.unit);
  if (options.common.json)
    print_json({{"response", options.to}, {"frequencies", response.frequency_hz.size()}});
  else if (!options.common.quiet)
    std::cout << "wrote " << options.to << ": " << response.frequency_hz.size() << " frequencies\n";
}

void write(const ConvertOptions& options, const std::string& file, const signals::Record& record) {
  if (options.mat_version == "7.3" && signals::formats::extension_of(file) == ".mat")
    signals::formats::write_mat(file, record, signals::formats::MatVersion::v7_3);
  else
    signals::write_record(file, record);
}

// "out_2.csv" for the second piece of "out.csv".
std::string file_of_piece(const std::string& file, const std::size_t piece) {
  std::filesystem::path path(file);
  path.replace_filename(path.stem().string() + "_" + std::to_string(piece + 1) +
                        path.extension().string());
  return path.string();
}

void convert(const ConvertOptions& options) {
  if (signals::formats::extension_of(options.to) != ".mat")
    refuse_given(*options.command, {"--mat-version"}, "is for files that end in .mat");
  const signals::Recording recording = options.record.read_pieces(options.from);
  nlohmann::json written = nlohmann::json::array();
  const bool is_one = recording.pieces.size() == 1;
  for (std::size_t i = 0; i < recording.pieces.size(); ++i) {
    const signals::Record& record = recording.pieces[i];
    const std::string file = is_one ? options.to : file_of_piece(options.to, i);
    refuse_overwriting({options.from}, {file});
    write(options, file, record);
    written.push_back(written_record_json(file, record));
    if (!options.common.json && !options.common.quiet)
      std::cout << written_record_text(file, record);
  }
  if (options.common.json) print_json(is_one ? written.front() : written);
}

}  // namespace

void add_convert_command(CLI::App& app) {
  const auto options = std::make_shared<ConvertOptions>();
  auto* command = app.add_subcommand(
      "convert",
      "Converts a record from one file format to another, units to SI; where samples are lost, "
      "each piece becomes a file (OUT_1, OUT_2, ...)");
  options->command = command;
  command
      ->add_option("from", options->from,
                   "Record: .csv, .mat (MATLAB 4, 5, 7.3), .h5, .hdf5, .npy, .uff, .unv, .uf58 "
                   "(Universal File, type 58), .wav, else text")
      ->required();
  command->add_option("to", options->to, "File written: .csv, .mat, .h5, .hdf5, .npy, .uff, .unv")
      ->required();
  command->add_option("--mat-version", options->mat_version, "Version of a .mat file")
      ->check(CLI::IsMember({"5", "7.3"}))
      ->capture_default_str();
  command->add_flag("--frequency-response", options->frequency_response,
                    "The file holds a frequency response base acceleration -> base moment: a "
                    "Universal File (function of type 4), a .mat or a CSV; written as .uff, .unv, "
                    ".uf58, .mat or .csv");
  command->add_option("--response-as", options->response_as,
                      "For --frequency-response: name, unit and factor of the response, "
                      "NAME[unit]*FACTOR[unit], e.g. 'H[mN mm/g]' or '[uT/g]*0.18[N m/T]'; in a "
                      "Universal File with several responses NAME is the number of one");
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa convert bench.mat bench.csv --column 'base_acceleration=ax[g]' \\\n"
      "    --column 'base_moment=B[uT]*0.18[N m/T]' --rate 500\n"
      "  vibrissa convert record.csv record.uff\n"
      "  vibrissa convert modal_test.uff response.mat --frequency-response");
  command->callback([options] {
    refuse_overwriting({options->from}, {options->to});
    if (options->frequency_response || !options->response_as.empty())
      convert_response(*options);
    else
      convert(*options);
  });
}

}  // namespace vibrissa::apps
