#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Expected log likelihood ratio against every sensor without the effect from which on the effect
/// counts as detected [nats]: the prior cost of naming one of thirty effects plus the Occam factor
/// of its parameter. For one parameter in Gaussian noise this is four standard deviations.
inline constexpr double detection_threshold_nats = 8.;
/// Expected log likelihood ratio below which two effects are indistinguishable
/// (named_answers.h).
inline constexpr double nats_to_tell_apart = 2.;

/// What else may differ from the simulation. exact: only the noise levels and the joint's share.
/// as_built: also the calibration parameters, within building tolerances. Half of all sensors are
/// of either kind (calibration_choices.h).
enum class SensorKind { exact, as_built };
inline constexpr std::array sensor_kinds{SensorKind::exact, SensorKind::as_built};

/// What an experiment can detect of one effect on a sensor of one kind.
struct Detectability {
  double nats = 0.;       // expected log likelihood ratio at typical strength
  bool detected = false;  // at typical strength
  /// Value of the size parameter from which on the effect is detected, with the other parameters as
  /// at the first start; nothing: not detected anywhere in its range.
  std::optional<double> limit{};
  bool detected_at_any_size = false;  // the effect does not vanish with its parameter
  /// Effects that this one may be mistaken for at its typical strength, when it is detected.
  std::vector<std::string> alike{};
};

struct EffectPower {
  std::string effect{};
  bool shown = false;   // does the experiment contain what the effect needs?
  std::string needs{};  // what is missing otherwise
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
  /// Result for a part of the same records: what it detects and distinguishes is taken as known.
  const std::vector<EffectPower>* fewer_records = nullptr;
  std::function<void()> on_effect = {};  // after each effect, one at a time
};

/// Detectability of every effect of the catalogue, for records of the nominal sensor with white
/// noise.
///   detected: the whitened change that remains when all other free parameters of the sensor follow
///   it (projection.h), except the effect's own calibration parameter.
///   alike: when the other effect's parameters follow as well, less than two nats remain, or less
///   than the other's model form error hides.
/// Proven by tests/diagnosis/planning/effect_power_test.cc.
std::vector<EffectPower> effect_powers(const Experiment& experiment, const ChannelNoise& noise,
                                       const PowerOptions& options = {});

}  // namespace vibrissa::diagnosis
