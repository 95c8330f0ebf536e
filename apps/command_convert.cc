#include <iostream>
#include <memory>

#include "apps/command.h"
#include "apps/record_options.h"
#include "signals/formats/file_format.h"
#include "signals/formats/mat_file.h"
#include "signals/record_io.h"

namespace vibrissa::apps {
namespace {

struct ConvertOptions {
  CommonOptions common;
  RecordOptions record;
  std::string from, to;
  std::string mat_version = "5";
};

void convert(const ConvertOptions& options) {
  const signals::Record record = options.record.read(options.from);
  if (options.mat_version == "7.3" && signals::formats::extension_of(options.to) == ".mat")
    signals::formats::write_mat(options.to, record, signals::formats::MatVersion::v7_3);
  else
    signals::write_record(options.to, record);
  if (options.common.json)
    print_json(written_record_json(options.to, record));
  else if (!options.common.quiet)
    std::cout << written_record_text(options.to, record);
}

}  // namespace

void add_convert_command(CLI::App& app) {
  const auto options = std::make_shared<ConvertOptions>();
  auto* command = app.add_subcommand(
      "convert", "A record from one file format to another, its units converted to SI");
  command
      ->add_option("from", options->from,
                   "Record: .csv, .mat (MATLAB 4, 5, 7.3), .h5, .hdf5, .npy, .uff, .unv, .uf58 "
                   "(Universal File, type 58), .wav")
      ->required();
  command->add_option("to", options->to, "File written: .csv, .mat, .h5, .hdf5, .npy, .uff, .unv")
      ->required();
  command->add_option("--mat-version", options->mat_version, "Version of a .mat file")
      ->check(CLI::IsMember({"5", "7.3"}))
      ->capture_default_str();
  options->record.add_to(*command);
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa convert bench.mat bench.csv --column 'base_acceleration=ax[g]' \\\n"
      "    --column 'base_moment=B[uT]*0.18[N m/T]' --rate 500\n"
      "  vibrissa convert record.csv record.uff");
  command->callback([options] { convert(*options); });
}

}  // namespace vibrissa::apps
