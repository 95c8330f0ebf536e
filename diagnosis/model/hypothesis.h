#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis {

/// The calibration effects that are free in every hypothesis: stiffness, damping, gains and drag.
const std::vector<std::string>& nuisance_ids();

/// A set of effects that together may explain the gap, beside the nuisances. Sorted by id.
class Hypothesis {
 public:
  Hypothesis() = default;
  explicit Hypothesis(std::vector<const Effect*> effects);

  /// No physics: errors of unknown course, in proportion to the moment, their level free in each of
  /// a few bands. Its name is outside_catalogue.
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

inline const std::string outside_catalogue = "outside_catalogue";
/// An unknown effect is as likely as one of the known ones.
constexpr double log_prior_of_outside_catalogue = -4.;
/// Of naming these n of n_known effects: how many there are, and that it is just these. Each
/// beyond three costs as much again.
double log_prior_of_number(std::size_t n, std::size_t n_known);

/// Ids in alphabetical order joined by '+'; "none" for none.
std::string joined_name(std::vector<std::string> ids);
/// The reverse: ids of "a+b"; none for "none".
std::vector<std::string> effect_ids(const std::string& name);

}  // namespace vibrissa::diagnosis
