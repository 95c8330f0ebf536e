#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {

/// The calibration effects that are free in every hypothesis: stiffness, damping, gains and drag.
const std::vector<std::string>& nuisance_ids();

/// A set of effects that together may explain the gap, in addition to the nuisances. Sorted by id.
class Hypothesis {
 public:
  Hypothesis() = default;
  explicit Hypothesis(std::vector<const Effect*> effects);

  /// A discrepancy without physics: random errors proportional to the moment, with a free level in
  /// each of a few bands. Its name is outside_catalogue.
  static Hypothesis discrepancy();

  const std::vector<const Effect*>& effects() const { return effects_; }
  bool is_discrepancy() const { return discrepancy_; }
  bool contains(const std::string& id) const;
  /// Ids joined by '+' in alphabetical order; "none" when empty.
  std::string name() const;
  Hypothesis with(const Effect& effect) const;
  Hypothesis without(const Effect& effect) const;

 private:
  std::vector<const Effect*> effects_;
  bool discrepancy_ = false;
};

/// Share of the gap from which on a change of the simulation is named.
inline constexpr double least_share = 0.05;

inline const std::string outside_catalogue = "outside_catalogue";
/// An unknown effect is as probable as each of the known ones.
constexpr double log_prior_of_outside_catalogue = -4.;
/// Log prior of naming n of n_known effects: of the number n, and of this selection. Each effect
/// beyond three costs the same again.
double log_prior_of_number(std::size_t n, std::size_t n_known);

/// Ids in alphabetical order joined by '+'; "none" for none.
std::string joined_name(std::vector<std::string> ids);
/// The inverse: ids of "a+b"; empty for "none".
std::vector<std::string> effect_ids(const std::string& name);

}  // namespace vibrissa::diagnosis
