#include "reproduction/reproduction_page.h"

#include <cmath>

#include "reproduction/paper_rig.h"

namespace vibrissa::reproduction {
namespace {

constexpr double near_share = 0.1;

struct Agreement {
  std::size_t near = 0, compared = 0;
};

/// Counts the numbers that both the paper and this program give.
Agreement agreement(const std::vector<PaperNumber>& numbers) {
  Agreement found;
  for (const PaperNumber& n : numbers) {
    if (!n.paper || !n.ours) continue;
    ++found.compared;
    if (std::abs(*n.ours - *n.paper) <= near_share * std::abs(*n.paper)) ++found.near;
  }
  return found;
}

}  // namespace

report::Page reproduction_page(const Reproduction& reproduction,
                               const std::vector<report::Figure>& figures) {
  const std::vector<PaperNumber> numbers = paper_numbers(reproduction);
  const Agreement found = agreement(numbers);
  const std::string share = std::to_string(found.near) + " of " + std::to_string(found.compared);
  return {.title = "Reproduction of the reference paper: figures and numbers",
          .headline = share + " numbers of the paper are reproduced within 10 %",
          .verdict = {"The \"experiment\" is a simulation with the published parameters and noise "
                      "of the built sensor."},
          .sections = {
              {.heading = "Numbers", .tables = {{"numbers", "Numbers", numbers_table(numbers)}}},
              {.heading = "Figures", .figures = figures},
              {.heading = "Separation",
               .text = {views::metric_notes(paper::settling_s)},
               .tables = {{"simulation", "Simulation",
                           views::separation_table(reproduction.simulation.separated)},
                          {"experiment", "Simulated experiment",
                           views::separation_table(reproduction.experiment.separated)}}},
              {.heading = "Settings of the adaptive filter",
               .text = {explain(reproduction.readings)},
               .tables = {{"fdaf_readings", "Settings applied to the simulated experiment",
                           readings_table(reproduction.readings)}}}}};
}

}  // namespace vibrissa::reproduction
