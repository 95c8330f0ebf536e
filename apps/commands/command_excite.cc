#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "apps/command_line/command.h"
#include "apps/command_line/record_options.h"
#include "apps/command_line/refused_options.h"
#include "apps/command_line/results.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/unit.h"
#include "signals/excitation/excitation.h"
#include "signals/record/channel_name.h"
#include "signals/record/record.h"
#include "signals/system/output_file.h"

namespace vibrissa::apps {

namespace {

namespace fs = std::filesystem;
using signals::ExcitationKind;
using signals::LineGrid;
using signals::LineRole;
using signals::PhaseRule;
using signals::SweepLaw;
using signals::WavFormat;

const std::map<std::string, ExcitationKind> kinds{{"multisine", ExcitationKind::multisine},
                                                  {"sweep", ExcitationKind::sweep},
                                                  {"noise", ExcitationKind::noise}};
const std::map<std::string, LineGrid> grids{
    {"full", LineGrid::full}, {"odd", LineGrid::odd}, {"random-odd", LineGrid::random_odd}};
const std::map<std::string, PhaseRule> phases{{"schroeder", PhaseRule::schroeder},
                                              {"random", PhaseRule::random},
                                              {"optimised", PhaseRule::optimised}};
const std::map<std::string, SweepLaw> sweeps{{"linear", SweepLaw::linear},
                                             {"logarithmic", SweepLaw::logarithmic}};
const std::map<std::string, WavFormat> formats{{"float32", WavFormat::float32},
                                               {"pcm24", WavFormat::pcm24}};

struct ExciteOptions {
  const CLI::App* command = nullptr;
  CommonOptions common;
  signals::ExcitationDesign design;
  std::string kind = "multisine", grid = "random-odd", phase = "optimised", sweep = "logarithmic",
              wav_format = "float32", channel = "base_acceleration";
  std::optional<std::size_t> period_samples;
  std::optional<double> resolution_hz;
  std::optional<std::string> folder, unit;
  bool wav = false;
};

template <typename Value>
Value chosen(const std::map<std::string, Value>& values, const std::string& name,
             const std::string& option) {
  const auto found = values.find(name);
  if (found != values.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& entry : values) known.push_back(entry.first);
  throw signals::UserError(option + ": " + signals::unknown_name("choice", name, known));
}

std::size_t period_of(const ExciteOptions& options) {
  if (!options.resolution_hz) return options.period_samples.value_or(2048);
  const double resolution = *options.resolution_hz;
  const double samples = options.design.sampling_rate_hz / resolution;
  if (options.period_samples)
    throw signals::UserError("--period and --resolution state the same thing; give one of them");
  if (!(resolution > 0.) || !(samples >= 2. && samples <= 1e8) ||
      std::abs(samples - std::round(samples)) > 1e-6 * samples)
    throw signals::UserError("--resolution: a period of 1 / " + signals::to_text(resolution) +
                             " s is no whole number of samples at " +
                             signals::to_text(options.design.sampling_rate_hz) +
                             " Hz; choose another resolution or rate");
  return static_cast<std::size_t>(std::lround(samples));
}

signals::ExcitationDesign resolved(const ExciteOptions& options) {
  signals::ExcitationDesign design = options.design;
  const std::string channel = signals::known_channel(options.channel);
  if (options.unit)
    design.unit = *options.unit;
  else if (channel != signals::channel::base_acceleration)
    design.unit = signals::unit_of_channel(channel);
  design.kind = chosen(kinds, options.kind, "--kind");
  design.grid = chosen(grids, options.grid, "--grid");
  design.phase = chosen(phases, options.phase, "--phase");
  design.sweep_law = chosen(sweeps, options.sweep, "--sweep");
  design.period_samples = period_of(options);
  return design;
}

std::string drive_name(const signals::DesignedExcitation& excitation, const signals::Drive& drive) {
  const auto& levels = excitation.design.levels;
  const auto level = std::ranges::find(levels, drive.level) - levels.begin() + 1;
  std::string name = "drive";
  if (levels.size() > 1) name += "_level" + std::to_string(level);
  if (excitation.design.n_realisations > 1)
    name += "_realisation" + std::to_string(drive.realisation);
  return name;
}

std::string channel_of(const ExciteOptions& options) {
  return signals::known_channel(options.channel);
}

// Before the design, which may take seconds.
void check_options(const ExciteOptions& options) {
  const auto& levels = options.design.levels;
  const double rate = options.design.sampling_rate_hz;
  if (std::set<double>(levels.begin(), levels.end()).size() != levels.size())
    throw signals::UserError("--levels: a level is given twice");
  if (options.wav && rate != std::floor(rate))
    throw signals::UserError(
        "--wav: the sampling rate of a sound file is a whole number of hertz, not " +
        signals::to_text(rate) + "; choose another --rate");
  const std::string channel = channel_of(options);
  try {
    if (options.unit) signals::convert_unit(*options.unit, signals::unit_of_channel(channel));
  } catch (const signals::UnitError& error) {
    throw signals::UserError("--unit, of " + channel + ": " + error.what());
  }
  chosen(formats, options.wav_format, "--wav-format");
}

void write_files(const ExciteOptions& options, const signals::DesignedExcitation& excitation,
                 const fs::path& folder, nlohmann::json& document) {
  const std::string channel = channel_of(options);
  const WavFormat format = chosen(formats, options.wav_format, "--wav-format");
  signals::make_new_folder(folder);
  for (std::size_t i = 0; i < excitation.drives.size(); ++i) {
    const auto& drive = excitation.drives[i];
    const std::string name = drive_name(excitation, drive);
    signals::write_drive_record(folder / (name + ".csv"), excitation, drive, channel);
    document["drives"][i]["csv"] = name + ".csv";
    if (!options.wav) continue;
    signals::write_drive_wav(folder / (name + ".wav"), excitation, drive, format);
    document["drives"][i]["wav"] = name + ".wav";
  }
  if (options.wav)
    document["wav_scale"] = "1.0 in the file is " + signals::to_text(excitation.full_scale()) +
                            " " + excitation.design.unit;
  signals::write_file(folder / "excitation.json",
                      [&](std::ostream& stream) { stream << document.dump(2) << '\n'; });
}

// The first lines of a list that may have hundreds.
std::string some_frequencies(const signals::DesignedExcitation& excitation, LineRole role) {
  constexpr std::size_t n_shown = 8;
  std::ostringstream text;
  std::size_t n = 0;
  for (const auto& line : excitation.lines) {
    if (line.role != role) continue;
    if (n < n_shown) text << (n > 0 ? ", " : "") << std::setprecision(5) << line.frequency_hz;
    ++n;
  }
  if (n > n_shown) text << ", ...";
  return std::to_string(n) + " lines [Hz]: " + text.str();
}

void print_lines(const signals::DesignedExcitation& excitation) {
  std::cout << signals::name_of(excitation.design.grid) << " grid, lines "
            << excitation.resolution_hz() << " Hz apart\n";
  for (const LineRole role :
       {LineRole::excited, LineRole::even_detection, LineRole::odd_detection}) {
    if (std::ranges::none_of(excitation.lines, [&](const auto& line) { return line.role == role; }))
      continue;
    std::cout << "  " << signals::name_of(role) << ", " << some_frequencies(excitation, role)
              << "\n    reveal " << signals::revelation(excitation.design.grid, role) << "\n";
  }
}

void print_text(const ExciteOptions& options, const signals::DesignedExcitation& excitation,
                const fs::path& folder) {
  const auto& design = excitation.design;
  std::cout << signals::name_of(design.kind) << ", " << design.low_hz << " .. " << design.high_hz
            << " Hz, " << design.n_lead_in_periods << " + " << design.n_periods << " periods of "
            << design.period_samples << " samples at " << design.sampling_rate_hz
            << " Hz; drop the first " << design.n_lead_in_periods << " when measuring\n";
  if (design.kind == ExcitationKind::multisine) print_lines(excitation);
  for (const auto& drive : excitation.drives)
    std::cout << drive_name(excitation, drive) << ": level " << drive.level << ", realisation "
              << drive.realisation << ", peak " << drive.level * design.peak << " " << design.unit
              << ", crest factor " << std::setprecision(4) << drive.crest_factor << "\n";
  if (options.wav)
    std::cout << "1.0 in the WAV files is " << signals::to_text(excitation.full_scale()) << " "
              << design.unit << "\n";
  std::cout << "written to " << folder.string() << "\n";
}

void refuse_unused(const ExciteOptions& options) {
  const auto refuse = [&](const std::vector<std::string>& names, const std::string& reason) {
    refuse_given(*options.command, names, reason);
  };
  if (options.kind != "multisine") refuse({"--grid", "--group", "--phase"}, "is for a multisine");
  if (options.kind != "sweep") refuse({"--sweep", "--fade"}, "is for --kind sweep");
  if (options.kind == "sweep") refuse({"--seed"}, "is for random drives, which a sweep is not");
  if (options.grid != "random-odd") refuse({"--group"}, "is for --grid random-odd");
  if (!options.wav) refuse({"--wav-format"}, "needs --wav");
  // The first realisation begins with Schroeder's phases, unless they are to be random.
  const bool has_random_phases = options.phase == "random" || (options.phase == "optimised" &&
                                                               options.design.n_realisations > 1);
  if (options.kind == "multisine" && options.grid != "random-odd" && !has_random_phases)
    refuse({"--seed"},
           "is for random lines or phases (--grid random-odd, --phase random, or several "
           "--realisations)");
}

void excite(const ExciteOptions& options) {
  check_options(options);
  refuse_unused(options);
  const auto excitation = signals::design_excitation(resolved(options));
  nlohmann::json document = signals::to_json(excitation);
  document["channel"] = channel_of(options);
  std::optional<fs::path> folder;
  if (options.folder)
    folder = *options.folder;
  else if (options.wav || !options.common.json)
    folder = free_results_folder("excite");
  if (folder) write_files(options, excitation, *folder, document);
  if (options.common.json)
    print_json(document);
  else
    print_text(options, excitation, *folder);
}

void add_signal_options(CLI::App& command, ExciteOptions& options) {
  auto& design = options.design;
  command
      .add_option("--kind", options.kind,
                  "multisine, sweep or noise (one random block, repeated as a period)")
      ->capture_default_str();
  command.add_option("--low", design.low_hz, "Lowest frequency [Hz]")->capture_default_str();
  command.add_option("--high", design.high_hz, "Highest frequency [Hz]")->capture_default_str();
  command.add_option("--rate", design.sampling_rate_hz, "Sampling rate [Hz]")
      ->capture_default_str();
  command.add_option("--period", options.period_samples,
                     "Period, or length of one sweep [samples] (default 2048)");
  command.add_option("--resolution", options.resolution_hz, "1 / period [Hz], instead of --period");
  command.add_option("--grid", options.grid, "Lines of a multisine: full, odd or random-odd")
      ->capture_default_str();
  command
      .add_option("--group", design.group_size,
                  "random-odd grid: one line of each group of this many odd lines is left out as "
                  "detection line")
      ->capture_default_str();
  command.add_option("--phase", options.phase, "schroeder, random or optimised")
      ->capture_default_str();
  command.add_option("--sweep", options.sweep, "linear or logarithmic")->capture_default_str();
  command
      .add_option("--fade", design.fade_s,
                  "Time over which a sweep fades in and out at its ends [s]")
      ->capture_default_str();
  command.add_option("--peak", design.peak, "Peak at level 1, in the unit of --unit")
      ->capture_default_str();
  command.add_option("--unit", options.unit,
                     "Unit of --peak, e.g. g (default: the channel's, m/s^2); CSV "
                     "files are in SI");
  command.add_option("--seed", design.seed, "Seed of phases, detection lines and noise")
      ->check(not_negative_number())
      ->capture_default_str();
}

}  // namespace

void add_excite_command(CLI::App& app) {
  const auto options = std::make_shared<ExciteOptions>();
  auto* command =
      app.add_subcommand("excite",
                         "Designs the wanted motion of the base (the shaker's own response is not "
                         "corrected): multisine with detection lines, sweep or noise");
  options->command = command;
  add_signal_options(*command, *options);
  auto& design = options->design;
  command->add_option("--periods", design.n_periods, "Number of periods to be recorded")
      ->capture_default_str();
  command
      ->add_option(
          "--lead-in", design.n_lead_in_periods,
          "Number of periods sent before the recorded ones; choose enough for transients to decay")
      ->capture_default_str();
  command
      ->add_option("--realisations", design.n_realisations,
                   "Number of drives, each with other random phases")
      ->capture_default_str();
  command
      ->add_option("--levels", design.levels,
                   "Multiples of the peak, one file each, e.g. 0.25,0.5,1")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option(
      "-o,--output,--out", options->folder,
      "New folder for the drives (CSV, WAV) and excitation.json (default: results/excite, or "
      "results/excite-2, ... if it exists; with --json only if this option or --wav is given)");
  command->add_flag("--wav", options->wav,
                    "Also writes sound files: the largest level reaches -1 and 1, smaller ones "
                    "keep their ratio to it; excitation.json says what 1 stands for");
  command->add_option("--wav-format", options->wav_format, "float32 or pcm24")
      ->capture_default_str();
  command
      ->add_option("--channel", options->channel,
                   "Channel of the CSV, e.g. base_acceleration or the shaker's coil_current "
                   "(docs/records.md)")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa excite --low 2 --high 200 --peak 0.4 --unit g --levels 0.25,0.5,1 -o drive "
      "--wav\n"
      "  vibrissa excite --kind sweep --period 30000 --fade 0.5 -o sweep");
  command->callback([options] { excite(*options); });
}

}  // namespace vibrissa::apps
