#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "apps/command_line/command.h"
#include "apps/solid/blas_kernel.h"
#include "report/figures/table.h"
#include "report/files/child_process.h"
#include "signals/base/revision.h"

namespace vibrissa::apps {
namespace {

/// One thing that a run needs or likes, as it is on this machine.
struct Check {
  std::string what, found, advice;  // no advice: all is well
};

bool is_on_path(const std::string& program) {
  return !report::find_program(program).empty();
}

Check check_display() {
  const bool has_display = std::getenv("DISPLAY") != nullptr;
  const bool has_virtual = is_on_path("xvfb-run") && is_on_path("xauth");
  if (has_display) return {"display", "DISPLAY is set", ""};
  if (has_virtual) return {"display", "none; xvfb-run gives a virtual one", ""};
  return {"display", "none", "shapes in 3-D cannot be drawn: apt-get install xvfb xauth"};
}

Check check_blas() {
  const std::string kernel = blas_kernel_name();
  if (kernel.empty())
    return {"BLAS", "not OpenBLAS",
            "factorisations are about five times slower: apt-get install libopenblas0-serial"};
  return {"BLAS", "OpenBLAS for " + kernel,
          kernel == slow_blas_kernel
              ? "OpenBLAS does not know this processor: set OPENBLAS_CORETYPE, e.g. to Haswell"
              : ""};
}

Check check_mpi() {
  if (is_on_path("mpirun")) return {"MPI", "mpirun is there", ""};
  return {"MPI", "no mpirun", "one process only: apt-get install openmpi-bin"};
}

Check check_memory() {
  std::ifstream in("/proc/meminfo");
  std::optional<double> available_gib;
  for (std::string name, unit; in >> name;) {
    double value = 0.;
    if (!(in >> value)) break;
    std::getline(in, unit);
    if (name == "MemAvailable:") available_gib = value / (1024. * 1024.);
  }
  if (!available_gib) return {"memory", "not known: /proc/meminfo says nothing", ""};
  const std::string found = report::Cell(*available_gib).rounded(3) + " GiB free";
  constexpr double for_default_case_gib = 2.;
  if (*available_gib >= for_default_case_gib) return {"memory", found, ""};
  return {"memory", found,
          "the built-in case needs 2 GiB: close something, or take Mesh resolution = 1"};
}

Check check_processors() {
  const unsigned n = std::thread::hardware_concurrency();
  return {"processors", std::to_string(n),
          n == 0 ? "the number of processors is not known: diagnosis uses one" : ""};
}

Check check_folder() {
  const bool writable = ::access(".", W_OK) == 0;
  std::error_code unknown;
  const auto space = std::filesystem::space(".", unknown);
  if (!writable)
    return {"this folder", "cannot be written",
            "results are written below it: change to another folder, or give --out"};
  if (unknown) return {"this folder", "writable", ""};
  const double free_gib = static_cast<double>(space.available) / (1 << 30);
  constexpr double least_gib = 1.;
  const std::string found = "writable, " + report::Cell(free_gib).rounded(3) + " GiB free";
  return {"this folder", found,
          free_gib < least_gib ? "a run with VTK files takes about 1 GiB" : ""};
}

Check check_units() {
  const bool there = std::getenv("UDUNITS2_XML_PATH") != nullptr ||
                     std::filesystem::exists("/usr/share/xml/udunits/udunits2.xml");
  return {
      "units", there ? "UDUNITS-2 is there" : "no UDUNITS-2",
      there ? "" : "columns with units, as ax[g], are refused: apt-get install libudunits2-data"};
}

Check check_calculix() {
  const bool there = is_on_path("ccx");
  return {"CalculiX", there ? "ccx is there" : "no ccx",
          there ? "" : "needed by comparisons in the tests only: apt-get install calculix-ccx"};
}

void doctor(const CommonOptions& common) {
  const std::vector<Check> checks = {check_processors(), check_memory(),  check_folder(),
                                     check_blas(),       check_mpi(),     check_display(),
                                     check_units(),      check_calculix()};
  if (common.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Check& check : checks)
      list.push_back({{"what", check.what}, {"found", check.found}, {"advice", check.advice}});
    print_json({{"program", signals::program_revision()}, {"checks", list}});
    return;
  }
  report::Table table({{"what", ""}, {"found", ""}, {"advice", ""}});
  for (const Check& check : checks)
    table.add_row({check.what, check.found, check.advice.empty() ? "-" : check.advice});
  std::cout << "vibrissa " << signals::program_revision() << "\n" << table.to_text();
}

}  // namespace

void add_doctor_command(CLI::App& app) {
  const auto common = std::make_shared<CommonOptions>();
  auto* command = app.add_subcommand("doctor",
                                     "Checks display, BLAS, MPI, memory, disk and the library of "
                                     "units, and names what is missing");
  add_common_options(*command, *common);
  command->footer("Example:\n  vibrissa doctor");
  command->callback([common] { doctor(*common); });
}

}  // namespace vibrissa::apps
