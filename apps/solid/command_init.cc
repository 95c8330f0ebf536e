#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string_view>

#include "apps/command_line/command.h"
#include "case/case_file.h"
#include "case/embedded_cases.h"
#include "signals/base/error.h"
#include "signals/system/output_file.h"

namespace vibrissa::apps {
namespace {

struct InitOptions {
  CommonOptions common;
  std::string file = "sensor.prm", kind = "flow";
};

void write_text(const std::string& file, const std::string_view text) {
  signals::write_file(file, [&](std::ostream& out) { out << text; });
}

void init(const InitOptions& options) {
  if (std::filesystem::exists(options.file))
    throw signals::UserError(options.file +
                             ": this file exists and is not overwritten; name another file");
  write_text(options.file, options.kind == "flow" ? sensor_case::flow_sensor_case()
                                                  : sensor_case::whisker_sensor_case());
  // Every entry with its meaning, unit and range, the defaults filled in.
  write_text(options.file, sensor_case::CaseFile(options.file).resolved());
  if (options.common.json) {
    print_json({{"case", options.file}, {"kind", options.kind}});
  } else if (!options.common.quiet) {
    std::cout << "wrote " << options.file << ": every entry with its meaning, unit and range.\n"
              << "Next: change what differs in your sensor, then\n"
              << "  vibrissa modes " << options.file << "     (its resonances)\n"
              << "  vibrissa run " << options.file << "       (from mesh to separated signals)\n";
  }
}

}  // namespace

void add_init_command(CLI::App& app) {
  const auto options = std::make_shared<InitOptions>();
  auto* command = app.add_subcommand("init", "Writes a commented case file to start from");
  command->add_option("case", options->file, "File written")->capture_default_str();
  command->add_option("--kind", options->kind, "flow (wire with a fin of four blades) or whisker")
      ->check(CLI::IsMember({"flow", "whisker"}))
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer("Example:\n  vibrissa init my_sensor.prm --kind whisker");
  command->callback([options] { init(*options); });
}

}  // namespace vibrissa::apps
