#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::test {

/// A flexible whisker on a joint with one mode, whose joint gets laws of the catalogue.
struct SteadyRig {
  double frequency_hz = 40., damping_ratio = 0.03, gain = -6e-5, joint_share = 0.7;
  double peak_moment = 2e-3;  // N m, the reference value of the laws

  NominalModel nominal() const {
    NominalModel model;
    model.modes = {{.frequency_rad_s = w1(),
                    .damping_ratio = damping_ratio,
                    .base_gain = gain,
                    .base_rate = 2. * damping_ratio * gain * 0.6,
                    .wind_gain = -gain * 0.8,
                    .wind_rate = -2. * damping_ratio * gain * 0.6 * 0.8}};
    model.has_base = model.has_wind = true;
    model.joint_share = joint_share;
    return model;
  }
  double w1() const { return 2. * std::numbers::pi * frequency_hz; }
  Scales scales() const {
    return {.joint_moment_n_m = peak_moment,
            .duration_s = 10.,
            .first_mode_rad_s = w1(),
            .static_gain = std::abs(gain),
            .moment_rms_n_m = peak_moment / 3.};
  }

  struct Law {
    std::string id;
    std::vector<double> values;
  };
  Chain chain(const std::vector<Law>& laws) const {
    Chain out{.structure = nominal(), .joint_share = joint_share};
    for (const Law& law : laws) find_effect(law.id).extend(out, law.values, scales());
    return out;
  }
};

}  // namespace vibrissa::diagnosis::test
