#include "diagnosis/search/calibration_posterior.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

/// At most so many calibration effects (nuisance_ids()).
constexpr int most_effects = 8;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_effects, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_effects, most_effects>;

/// One state of a calibration effect: as simulated, or off by a normal distribution [scales of the
/// prior]. Cauchy's distribution is that of a normal variable over another one's magnitude; the
/// normals stand for the halves, quarters ... of that magnitude's distribution.
struct State {
  double weight, deviation;
};
constexpr std::array<State, 6> states{
    {{0.5, 0.}, {0.25, 0.869}, {0.125, 2.046}, {0.0625, 4.216}, {0.03125, 8.49}, {0.03125, 25.5}}};

/// First parameters of the calibration effects of a fit, which decide whether they vanish.
std::vector<Eigen::Index> deciding_parameters(const HypothesisFit& fit) {
  std::vector<Eigen::Index> out;
  for (std::size_t i = n_common_parameters; i < fit.fit_parameters.size(); ++i)
    if (fit.fit_parameters[i].nuisance && fit.fit_parameters[i].parameter == 0)
      out.push_back(static_cast<Eigen::Index>(i));
  return out;
}

/// Does the effect change the gain of one path alone, as an error of the simulation's gain does?
bool has_gain_of_one_path(const std::string& id) {
  return id == "reference_gain" || id == "drag_error";
}

struct Component {
  double log_weight = 0.;
  std::size_t off = 0;  // set of the effects that are off
  Vector mean, deviation;
};

void keep_probable(std::vector<Component>& components) {
  constexpr double hopeless_nats = 14.;
  const double most = std::ranges::max_element(components, {}, &Component::log_weight)->log_weight;
  for (Component& c : components) c.log_weight -= most;
  std::erase_if(components, [](const Component& c) { return c.log_weight < -hopeless_nats; });
}

class CalibrationMixture {
 public:
  explicit CalibrationMixture(const HypothesisFit& fit) : fit_(fit), at_(deciding_parameters(fit)) {
    assert(at_.size() <= most_effects);
    const Eigen::MatrixXd information = fit.covariance(at_, at_).inverse();
    information_ = information;
    Vector way(size()), slope(size());
    for (Eigen::Index i = 0; i < size(); ++i) {
      information_(i, i) -= prior(i).curvature(x(i));
      slope(i) = -prior(i).slope(x(i));
      way(i) = x(i) - prior(i).centre;
    }
    linear_ = slope + information_ * way;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(at_.size()); }
  const std::string& id(Eigen::Index i) const { return parameter(i).effect->id; }
  double x(Eigen::Index i) const { return fit_.x(at_[static_cast<std::size_t>(i)]); }
  const Prior& prior(Eigen::Index i) const { return parameter(i).description.prior; }

  /// All combinations of states. own_error: standard deviation of the simulation's own gain.
  std::vector<Component> components(const double own_error) const {
    std::vector<Component> out;
    Vector sensor(size()), total(size());
    const auto add = [&](const auto& self, Eigen::Index i, double weight, std::size_t off) -> void {
      if (i == size()) {
        out.push_back(component(sensor, total));
        out.back().log_weight += std::log(weight);
        out.back().off = off;
        return;
      }
      for (const State& state : states) {
        sensor(i) = state.deviation * prior(i).scale;
        total(i) = std::hypot(sensor(i), has_gain_of_one_path(id(i)) ? own_error : 0.);
        self(self, i + 1, weight * state.weight,
             off | static_cast<std::size_t>(state.deviation > 0.) << i);
      }
    };
    add(add, 0, 1., 0);
    keep_probable(out);
    return out;
  }

 private:
  const FitParameter& parameter(Eigen::Index i) const {
    return fit_.fit_parameters[static_cast<std::size_t>(at_[static_cast<std::size_t>(i)])];
  }

  /// Posterior of the sensor's part of each parameter, where sensor and simulation together have
  /// the deviations total.
  Component component(const Vector& sensor, const Vector& total) const {
    const Matrix precision = Matrix::Identity(size(), size()) +
                             Matrix(total.asDiagonal() * information_ * total.asDiagonal());
    const Eigen::LLT<Matrix> llt(precision);
    const Vector pulled = total.asDiagonal() * linear_, z = llt.solve(pulled);
    const Matrix factor = llt.matrixL();
    Component out{.log_weight = 0.5 * pulled.dot(z) - factor.diagonal().array().log().sum(),
                  .mean = Vector(size()),
                  .deviation = Vector(size())};
    const Matrix covariance = llt.solve(Matrix::Identity(size(), size()));
    for (Eigen::Index i = 0; i < size(); ++i) {
      // Regression of the sensor's part on the sum, and what the sum leaves open.
      const double part = total(i) > 0. ? sensor(i) / total(i) : 0.;
      out.mean(i) = part * sensor(i) * z(i);
      out.deviation(i) =
          sensor(i) * std::sqrt(std::max(0., part * part * covariance(i, i) + 1. - part * part));
    }
    return out;
  }

  const HypothesisFit& fit_;
  std::vector<Eigen::Index> at_;
  Matrix information_;  // of the likelihood alone
  Vector linear_;       // its slope at the centres of the priors
};

/// Quantile of one parameter of a mixture.
double quantile(const std::vector<Component>& components, const Eigen::Index i, const double p) {
  double low = 0., high = 0., sum = 0.;
  constexpr double reach = 8.;
  for (const Component& c : components) {
    low = std::min(low, c.mean(i) - reach * c.deviation(i));
    high = std::max(high, c.mean(i) + reach * c.deviation(i));
    sum += std::exp(c.log_weight);
  }
  constexpr int n_halvings = 40;
  for (int n = 0; n < n_halvings; ++n) {
    const double middle = 0.5 * (low + high);
    double below = 0.;
    for (const Component& c : components) {
      const double way = middle - c.mean(i);
      const double share = c.deviation(i) > 0.
                               ? 0.5 * std::erfc(-way / (std::sqrt(2.) * c.deviation(i)))
                               : static_cast<double>(way >= 0.);
      below += std::exp(c.log_weight) * share;
    }
    (below < p * sum ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<std::string> needless_calibrations(const HypothesisFit& fit) {
  const CalibrationMixture mixture(fit);
  const std::vector<Component> components = mixture.components(0.);
  const std::size_t off = std::ranges::max_element(components, {}, &Component::log_weight)->off;
  std::vector<std::string> out;
  for (Eigen::Index i = 0; i < mixture.size(); ++i)
    if ((off >> i & 1) == 0) out.push_back(mixture.id(i));
  return out;
}

std::map<std::string, std::array<double, 2>> calibration_intervals(
    const HypothesisFit& fit, const double simulation_accuracy) {
  constexpr double tail = 0.025;
  const CalibrationMixture mixture(fit);
  const std::vector<Component> components = mixture.components(simulation_accuracy);
  std::map<std::string, std::array<double, 2>> out;
  for (Eigen::Index i = 0; i < mixture.size(); ++i) {
    const double centre = mixture.prior(i).centre;
    out[mixture.id(i)] = {centre + quantile(components, i, tail),
                          centre + quantile(components, i, 1. - tail)};
  }
  return out;
}

}  // namespace vibrissa::diagnosis
