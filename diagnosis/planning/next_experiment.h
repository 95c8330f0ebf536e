#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// One experiment of the menu. It distinguishes two effects when their observations differ; it does
/// not change effects that are not listed.
struct MenuEntry {
  std::string name{};
  std::string what{};                          // what to do on the bench
  std::map<std::string, std::string> shows{};  // effect id -> observation
};

/// The experiments that a bench can make (docs/effects.md).
const std::vector<MenuEntry>& experiment_menu();

struct NextExperiment {
  std::string name = "none";
  std::string why{};
  std::vector<std::string> would_separate{};
  /// Probability that the experiment distinguishes two answers drawn from the remaining ones.
  double split_probability = 0.;
};

void to_json(nlohmann::ordered_json& out, const NextExperiment& next);

/// The experiment that best distinguishes the answers of the confidence set and of the
/// indistinguishable sets. possible: names of the experiments that the bench can make; empty: all.
/// Proven by tests/diagnosis/planning/next_experiment_test.cc.
NextExperiment next_experiment(const std::vector<Candidate>& candidates,
                               const std::vector<std::string>& confidence_set,
                               const std::vector<std::vector<std::string>>& indistinguishable,
                               const std::vector<std::string>& possible = {});

/// Throws UserError with the known names when a name is not in the menu.
void check_menu_names(const std::vector<std::string>& names);

}  // namespace vibrissa::diagnosis
