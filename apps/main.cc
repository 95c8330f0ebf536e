#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/program_run.h"
#include "apps/command_line/programs.h"
#include "signals/base/error.h"
#include "signals/base/exit_status.h"

namespace {

namespace apps = vibrissa::apps;

/// The commands that need no solid. The others, help on all, and a case file are for the solid
/// program, which takes ten times as long to start.
constexpr std::array<std::pair<std::string_view, apps::AddCommand>, 8> of_records = {
    {{"check", apps::add_check_command},
     {"convert", apps::add_convert_command},
     {"diagnose", apps::add_diagnose_command},
     {"draw", apps::add_draw_command},
     {"excite", apps::add_excite_command},
     {"identify", apps::add_identify_command},
     {"plan", apps::add_plan_command},
     {"separate", apps::add_separate_command}}};

/// As Open MPI, and MPICH and Slurm, tell the processes that they start.
bool is_one_of_several() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr;
}

bool needs_solid(const std::vector<std::string>& words) {
  if (words.size() < 2 || is_one_of_several()) return true;
  if (words[1] == "--version") return false;
  return std::ranges::find(of_records, words[1], &decltype(of_records)::value_type::first) ==
             of_records.end() ||
         std::ranges::any_of(words, [](const std::string& word) { return word.ends_with(".prm"); });
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv, argv + argc);
  apps::prepare_program();
  std::vector<apps::AddCommand> commands;
  for (const auto& [name, add] : of_records) commands.push_back(add);
  const apps::Outcome outcome = apps::run_program(
      commands, argc, argv,
      [&] {
        if (needs_solid(words)) apps::become_program(apps::solid_program, words);
      },
      [](const std::exception&) { return false; }, false);
  if (!outcome.message.empty()) std::cerr << "vibrissa: " << outcome.message << std::endl;
  return outcome.status;
}
