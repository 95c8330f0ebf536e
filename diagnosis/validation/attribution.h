#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/validation/held_out.h"
#include "diagnosis/validation/parameter_estimates.h"

namespace vibrissa::diagnosis {

/// Shapley values (1953) of n players: each player's contribution, averaged over all orders.
/// worth(set): value of a set of players, given as bits; n must be small. The values sum to
/// worth(all) - worth(none). Proven by tests/diagnosis/validation/attribution_test.cc.
std::vector<double> shapley_values(std::size_t n, const std::function<double(std::size_t)>& worth);

/// One change of the simulation with its share of the reducible gap.
struct AttributedChange {
  std::string id{};
  bool calibration = false;
  /// Is its first parameter's 95 % interval without the nominal value? Effects: true.
  bool moved = true;
  double alone = 0.;   // share that it closes on its own
  double share = 0.;   // Shapley value: its share in the company of the other changes
  double missed = 0.;  // share of the gap that returns when it alone is left out
  std::optional<std::array<double, 2>> share_ci95{};  // block bootstrap
  std::vector<ParameterEstimate> parameters{};
};

/// Which change closes how much of the gap, in free simulation. Reducible gap: mean square error of
/// the nominal model minus that of the noise, both relative to the measured moment.
struct Attribution {
  ErrorScore error{};  // of the whole fit, in these records
  double reducible = 0.;
  std::vector<AttributedChange> changes{};  // largest share first
  double unexplained = 0.;                  // share of the reducible gap that is left
};

/// Attribution of the gap in records (prepared with InputNoise::as_measured) to the changes of a
/// fit. Effects that add process noise alone have the share 0. Shares and gap are zero when the
/// records have no error beyond noise. Proven by tests/diagnosis/validation/attribution_test.cc.
Attribution attribute_gap(const Experiment& fitted_on, const Experiment& records,
                          const HypothesisFit& fit);

/// The calibration parameters to be named: the 95 % interval excludes the nominal value, and they
/// close least_share or more of the gap, in company or as the last one (a wrong damping closes
/// nothing while the resonance is wrong). This part must be larger than the error that a simulation
/// of the given accuracy has anyway, and the whole gap larger than power_without_cause().
std::vector<std::string> named_calibrations(const Attribution& attribution, double accuracy);

}  // namespace vibrissa::diagnosis
