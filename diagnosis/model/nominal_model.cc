#include "diagnosis/model/nominal_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vibrissa::diagnosis {
namespace {

Complex compliance(const StructuralMode& mode, Complex x) {
  return 1. / (x * x + 2. * mode.damping_ratio * x + 1.);
}

}  // namespace

Complex StructuralMode::base_response(const Complex s) const {
  const Complex x = s / frequency_rad_s;
  return (base_gain + base_rate * x) * compliance(*this, x);
}

Complex StructuralMode::wind_response(const Complex s) const {
  const Complex x = s / frequency_rad_s;
  return (wind_gain + wind_rate * x) * compliance(*this, x);
}

double spring_ratio(const double ratio, const double share) {
  constexpr double least_compliance = 1e-3;
  return share / std::max(least_compliance, 1. / ratio - 1. + share);
}

double DragCurve::drag(const double speed) const {
  const double square = speed * std::abs(speed);
  if (speed_m_s.empty()) return square;
  const auto above = std::upper_bound(speed_m_s.begin(), speed_m_s.end(), speed);
  if (above == speed_m_s.begin()) return square * factor.front();
  if (above == speed_m_s.end()) return square * factor.back();
  const auto i = static_cast<std::size_t>(above - speed_m_s.begin());
  const double share = (speed - speed_m_s[i - 1]) / (speed_m_s[i] - speed_m_s[i - 1]);
  return square * std::lerp(factor[i - 1], factor[i], share);
}

const ParameterPath* NominalModel::path(const std::string& parameter) const {
  constexpr double least_exponent = 1e-3;
  const auto found = paths.find(parameter);
  if (found == paths.end() || found->second.frequency.empty()) return nullptr;
  return std::abs(found->second.frequency.front()) < least_exponent ? nullptr : &found->second;
}

std::string NominalModel::mass_parameter() const {
  for (const char* const name : {"fin_density", "wire_density"})
    if (path(name) != nullptr) return name;
  return "";
}

void NominalModel::follow(const ParameterPath& path, const double log_x) {
  assert(path.frequency.size() == modes.size() && path.base_gain.size() == modes.size() &&
         path.wind_gain.size() == modes.size());
  const auto factor = [&](const double exponent) { return std::exp(exponent * log_x); };
  double base = base_direct, wind = wind_direct;  // static moments
  for (const StructuralMode& mode : modes) base += mode.base_gain, wind += mode.wind_gain;
  base_direct = base * factor(path.static_base_moment);
  wind_direct = wind * factor(path.static_wind_moment);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    StructuralMode& mode = modes[k];
    mode.frequency_rad_s *= factor(path.frequency[k]);
    const double base_factor = factor(path.base_gain[k]), wind_factor = factor(path.wind_gain[k]);
    mode.base_gain *= base_factor;
    mode.base_rate *= base_factor;
    mode.wind_gain *= wind_factor;
    mode.wind_rate *= wind_factor;
    base_direct -= mode.base_gain;
    wind_direct -= mode.wind_gain;
  }
}

double NominalModel::joint_viscous_ratio() const {
  if (modes.empty()) return 0.;
  const StructuralMode& mode = modes.front();
  if (readout == signals::Readout::rotation) return 2. * mode.damping_ratio;
  return mode.base_gain != 0. ? mode.base_rate / mode.base_gain : 0.;
}

std::vector<double> NominalModel::higher_joint_weights() const {
  const ParameterPath* const silicone = path("silicone_modulus");
  std::vector<double> weights;
  for (std::size_t k = 1; k < modes.size(); ++k) {
    const double w = modes[k].frequency_rad_s;
    weights.push_back(silicone != nullptr ? std::max(0., silicone->frequency[k])
                                          : std::abs(modes[k].base_gain) * w * w);
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.);
  for (double& weight : weights) weight = sum > 0. ? weight / sum : 0.;
  return weights;
}

std::size_t NominalModel::decay_samples(const double n_time_constants,
                                        const double sampling_rate_hz) const {
  if (modes.empty()) return 0;
  const StructuralMode& mode = modes.front();
  return static_cast<std::size_t>(
      std::ceil(n_time_constants * sampling_rate_hz / (mode.damping_ratio * mode.frequency_rad_s)));
}

}  // namespace vibrissa::diagnosis
