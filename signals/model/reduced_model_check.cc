#include <array>
#include <cmath>
#include <span>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::signals {

namespace {

[[noreturn]] void refuse_model(const ReducedModel& model, const std::string& what) {
  throw UserError("reduced model '" + model.name + "': " + what);
}

/// Checks of one model; the name of an entry is built only for an error.
class Checker {
 public:
  explicit Checker(const ReducedModel& model) : model_(model) {}

  void require(bool fine, double value, const std::string& rule, auto... where) const {
    if (!fine) refuse_model(model_, name(where...) + " = " + to_text(value) + " " + rule);
  }
  void finite(std::span<const double> values, auto... where) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      require(std::isfinite(values[i]), values[i], "is not finite", where..., i);
  }
  void length(std::size_t found, std::size_t wanted, auto... where) const {
    if (found != wanted)
      refuse_model(model_, name(where...) + " has " + std::to_string(found) +
                               " entries instead of " + std::to_string(wanted));
  }

 private:
  static std::string part(const char* text) { return text; }
  static std::string part(std::size_t index) {
    return std::string("[").append(std::to_string(index)).append("]");
  }
  static std::string name(auto... where) { return (part(where) + ...); }

  const ReducedModel& model_;
};

void check_modes(const ReducedModel& model, const Checker& checker) {
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const ReducedMode& mode = model.modes[k];
    checker.require(mode.frequency_hz > 0. && std::isfinite(mode.frequency_hz), mode.frequency_hz,
                    "is not positive and finite", "modes", k, ".frequency_hz");
    checker.require(mode.damping_ratio >= 0. && std::isfinite(mode.damping_ratio),
                    mode.damping_ratio, "is negative or not finite", "modes", k, ".damping_ratio");
    checker.finite(mode.participation, "modes", k, ".participation");
    checker.finite(mode.moment_participation, "modes", k, ".moment_participation");
  }
}

void check_wind(const ReducedModel& model, const Checker& checker) {
  const WindLoad& wind = model.wind;
  const std::size_t n_speeds = wind.speed_m_s.size();
  checker.finite(wind.speed_m_s, "wind.speed_m_s");
  for (std::size_t i = 1; i < n_speeds; ++i)
    checker.require(wind.speed_m_s[i] > wind.speed_m_s[i - 1], wind.speed_m_s[i],
                    "is not above the speed before it", "wind.speed_m_s", i);
  checker.length(wind.modal_coefficient.size(), n_speeds, "wind.modal_coefficient");
  checker.length(wind.moment_coefficient.size(), n_speeds, "wind.moment_coefficient");
  for (std::size_t i = 0; i < n_speeds; ++i) {
    checker.length(wind.modal_coefficient[i].size(), model.modes.size(), "wind.modal_coefficient",
                   i);
    checker.finite(wind.modal_coefficient[i], "wind.modal_coefficient", i);
    checker.finite(wind.moment_coefficient[i], "wind.moment_coefficient", i);
  }
}

void check_sensitivities(const ReducedModel& model, const Checker& checker) {
  const std::size_t n_modes = model.modes.size();
  for (std::size_t i = 0; i < model.sensitivities.size(); ++i) {
    const Sensitivity& entry = model.sensitivities[i];
    const auto finite = [&](double value, const char* entry_name) {
      checker.require(std::isfinite(value), value, "is not finite", "sensitivities", i, entry_name);
    };
    finite(entry.nominal_value, ".nominal_value");
    finite(entry.static_base_moment, ".static_base_moment");
    finite(entry.static_wind_moment, ".static_wind_moment");
    checker.length(entry.frequency.size(), n_modes, "sensitivities", i, ".frequency");
    checker.length(entry.base_gain.size(), n_modes, "sensitivities", i, ".base_gain");
    if (!model.wind.speed_m_s.empty() || !entry.wind_gain.empty())
      checker.length(entry.wind_gain.size(), n_modes, "sensitivities", i, ".wind_gain");
    checker.finite(entry.frequency, "sensitivities", i, ".frequency");
    checker.finite(entry.base_gain, "sensitivities", i, ".base_gain");
    checker.finite(entry.wind_gain, "sensitivities", i, ".wind_gain");
  }
}

}  // namespace

void check(const ReducedModel& model) {
  const Checker checker(model);
  const std::array<double, 3>& axial = model.axial_direction;
  checker.finite(axial, "axial_direction");
  if (std::abs(std::hypot(axial[0], axial[1]) - 1.) > 1e-9 || std::abs(axial[2]) > 1e-9)
    refuse_model(model, "axial_direction is not a unit vector in the xy-plane");
  for (std::size_t i = 0; i < 3; ++i) checker.finite(model.rigid_moment[i], "rigid_moment", i);
  check_modes(model, checker);
  check_wind(model, checker);
  check_sensitivities(model, checker);
}

}  // namespace vibrissa::signals
