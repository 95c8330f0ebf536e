#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Expected log likelihood ratio against every sensor without the effect at which it counts as
/// found: what naming one of thirty effects costs in the prior, and its parameter's Occam factor.
/// Of one parameter in Gaussian noise: four standard deviations.
inline constexpr double detection_threshold_nats = 8.;
/// And below which two effects are alike (indistinguishable.h).
inline constexpr double nats_to_tell_apart = 2.;

/// What else may differ from the simulation: noise levels and joint alone, or, as built, the
/// calibrations too, a little (calibration_choices.h: half of all sensors are either).
enum class SensorKind { exact, as_built };
inline constexpr std::array sensor_kinds{SensorKind::exact, SensorKind::as_built};

/// What an experiment would say of one effect on a sensor of one kind.
struct Detectability {
  double nats = 0.;    // at typical strength
  bool found = false;  // at typical strength
  /// Value of the size parameter from which on the effect is found, the others as at the first
  /// start; nothing: nowhere up to the end of its range.
  std::optional<double> limit{};
  bool detected_at_any_size =
      false;  // however small: the effect does not go to nothing with its parameter
  /// Effects that may be taken for this one at its typical strength, when it is found.
  std::vector<std::string> alike{};
};

struct EffectPower {
  std::string effect{};
  bool shown = false;   // does the experiment hold what the effect needs?
  std::string needs{};  // what is missing when not
  std::string parameter{}, unit{};
  double typical = 0.;  // value of the size parameter at the effect's first start
  Detectability exact{}, as_built{};

  const Detectability& on(SensorKind kind) const {
    return kind == SensorKind::exact ? exact : as_built;
  }
  Detectability& on(SensorKind kind) { return kind == SensorKind::exact ? exact : as_built; }
};

struct PowerOptions {
  bool limits = true;
  std::size_t n_threads = 2;
  /// Of the same records but some: what it finds and tells apart is taken as known.
  const std::vector<EffectPower>* fewer_records = nullptr;
  std::function<void()> on_effect = {};  // after each effect, one at a time
};

/// Of every effect of the catalogue, for records of the nominal sensor with white noise.
///   found: the whitened change of mean and variance (fisher_changes.h) that is left when all that
///   the sensor may have besides follows it, but the effect's own calibration.
///   alike: what is left when the other effect's parameters follow it as well is less than two nats
///   or than the other's form error hides.
/// Followers are refitted (follower.h): strong effects are more than their tangents. Proven by
/// tests/diagnosis/planning/effect_power_test.cc.
std::vector<EffectPower> effect_powers(const Experiment& experiment, const ChannelNoise& noise,
                                       const PowerOptions& options = {});

}  // namespace vibrissa::diagnosis
