#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// One entry of the menu. Two effects are told apart when it shows them differently; effects that
/// are not listed are not changed by it.
struct MenuEntry {
  std::string name{};
  std::string what{};                          // to do on the bench
  std::map<std::string, std::string> shows{};  // effect id -> what one would see
};

/// The experiments that a bench can do, from "told apart by" of docs/effects.md.
const std::vector<MenuEntry>& experiment_menu();

struct NextExperiment {
  std::string name = "none";
  std::string why{};
  std::vector<std::string> would_separate{};
  /// Probability that two answers drawn from what is left would be told apart.
  double split_probability = 0.;
};

/// The entry that best splits the probability left in the confidence set and in the sets that this
/// experiment cannot tell apart. possible: names of the entries that the bench can do; empty: all.
/// Proven by tests/diagnosis/planning/next_experiment_test.cc.
NextExperiment next_experiment(const std::vector<Candidate>& candidates,
                               const std::vector<std::string>& confidence_set,
                               const std::vector<std::vector<std::string>>& indistinguishable,
                               const std::vector<std::string>& possible = {});

/// Throws UserError, with the known names, when one of them is no entry of the menu.
void check_menu_names(const std::vector<std::string>& names);

}  // namespace vibrissa::diagnosis
