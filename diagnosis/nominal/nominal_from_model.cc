
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "diagnosis/nominal/nominal_identification.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A mode with less influence on the moment than this share of the strongest one belongs to the
/// other plane.
constexpr double other_plane = 1e-6;
constexpr double usual_wind_m_s = 2.;

std::size_t nearest_speed(const signals::WindLoad& wind) {
  const auto nearest = std::ranges::min_element(
      wind.speed_m_s, {}, [](const double speed) { return std::abs(speed - usual_wind_m_s); });
  return static_cast<std::size_t>(nearest - wind.speed_m_s.begin());
}

/// Drag curve from the static moment, assumed for all modes. Empty when the drag coefficient is
/// constant.
DragCurve drag_curve(const signals::ReducedModel& model, const std::size_t usual) {
  constexpr double constant_within = 1e-4;
  const Vector axis = model.moment_axis();
  const double reference = dot(axis, model.wind.moment_coefficient[usual]);
  DragCurve curve{.speed_m_s = model.wind.speed_m_s, .factor = {}};
  for (const Vector& coefficient : model.wind.moment_coefficient)
    curve.factor.push_back(dot(axis, coefficient) / reference);
  const auto is_one = [](const double f) { return std::abs(f - 1.) < constant_within; };
  if (reference == 0. || std::all_of(curve.factor.begin(), curve.factor.end(), is_one)) return {};
  return curve;
}

/// Sensitivities of the modes with these numbers, and the joint's share.
void set_paths(NominalModel& nominal, const signals::ReducedModel& model,
               const std::vector<std::size_t>& numbers) {
  for (const signals::Sensitivity& sensitivity : model.sensitivities) {
    if (sensitivity.parameter == "silicone_modulus") {
      nominal.joint_share = std::clamp(2. * sensitivity.frequency.at(numbers.front()), 0.3, 1.);
      nominal.joint_share_deviation = 0.02;
      double higher = 0.;
      for (std::size_t i = 1; i < numbers.size(); ++i)
        higher += 2. * std::max(0., sensitivity.frequency.at(numbers[i]));
      if (nominal.joint_share < 1.)
        nominal.higher_joint_share = std::min(1., higher / (1. - nominal.joint_share));
      nominal.higher_joint_share_deviation = 0.05;
    }
    ParameterPath& path = nominal.paths[sensitivity.parameter];
    path.static_base_moment = sensitivity.static_base_moment;
    path.static_wind_moment = sensitivity.static_wind_moment;
    for (const std::size_t k : numbers) {
      path.frequency.push_back(sensitivity.frequency.at(k));
      path.base_gain.push_back(sensitivity.base_gain.at(k));
      path.wind_gain.push_back(sensitivity.wind_gain.empty() ? 0. : sensitivity.wind_gain.at(k));
    }
  }
}

}  // namespace

NominalModel nominal_from(const signals::ReducedModel& model) {
  signals::check(model);
  const Vector axis = model.moment_axis();
  const bool wind = !model.wind.speed_m_s.empty();
  const std::size_t speed = nearest_speed(model.wind);
  NominalModel nominal;
  nominal.has_base = true;
  nominal.has_wind = wind;
  for (std::size_t i = 0; i < 3; ++i)
    nominal.base_direct -= axis[i] * dot(model.rigid_moment[i], model.axial_direction);
  if (wind) {
    nominal.wind_direct = dot(axis, model.wind.moment_coefficient[speed]);
    nominal.drag_curve = drag_curve(model, speed);
  }
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const signals::ReducedMode& mode = model.modes[k];
    const double lever = dot(axis, mode.moment_participation);
    StructuralMode out{.frequency_rad_s = 2. * std::numbers::pi * mode.frequency_hz,
                       .damping_ratio = mode.damping_ratio,
                       .base_gain = -lever * dot(mode.participation, model.axial_direction)};
    out.base_rate = 2. * out.damping_ratio * out.base_gain;
    if (wind) out.wind_gain = lever * model.wind.modal_coefficient[speed][k];
    out.wind_rate = 2. * out.damping_ratio * out.wind_gain;
    nominal.base_direct -= out.base_gain;
    nominal.wind_direct -= out.wind_gain;
    nominal.modes.push_back(out);
    numbers.push_back(k);
  }
  const auto strength = [&](std::size_t k) { return std::abs(nominal.modes[k].base_gain); };
  std::ranges::sort(numbers, std::ranges::greater(), strength);
  if (numbers.empty() || strength(numbers.front()) == 0.)
    throw signals::UserError("model '" + model.name +
                             "': base acceleration along the axial direction excites no mode");
  const double least = other_plane * strength(numbers.front());
  std::erase_if(numbers, [&](const std::size_t k) { return strength(k) <= least; });
  const std::vector<StructuralMode> all = std::exchange(nominal.modes, {});
  for (const std::size_t k : numbers) nominal.modes.push_back(all[k]);
  set_paths(nominal, model, numbers);
  return nominal;
}

}  // namespace vibrissa::diagnosis
