#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/figures/table.h"
#include "reproduction/paper_sensors.h"
#include "reproduction/paper_trials.h"

namespace vibrissa::reproduction {

/// One number of the reference paper and the same number of this program.
struct PaperNumber {
  std::string what, unit;
  std::optional<double> paper, ours;  // nothing: not stated by the paper, not determined here
  std::string why;                    // explanation of a difference or agreement
};

/// All results of `vibrissa reproduce`.
struct Reproduction {
  PaperSensors sensors;
  PaperTrial simulation, experiment;
  double flow_srivc_fit_percent = 0., whisker_fit_percent = 0., whisker_srivc_fit_percent = 0.;
  std::vector<FdafReading> readings;
};

std::vector<PaperNumber> paper_numbers(const Reproduction& reproduction);
report::Table numbers_table(const std::vector<PaperNumber>& numbers);
report::Table readings_table(const std::vector<FdafReading>& readings);
/// Explains in words, from the computed numbers, why the paper's other settings fail.
std::string explain(const std::vector<FdafReading>& readings);
nlohmann::json reproduction_json(const Reproduction& reproduction);

}  // namespace vibrissa::reproduction
