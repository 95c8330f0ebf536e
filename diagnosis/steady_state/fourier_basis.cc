#include "diagnosis/steady_state/fourier_basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// Laws with corners have many harmonics; the orders beyond the samples fold back on the others.
std::size_t period_samples(const std::size_t highest) {
  constexpr std::size_t least = 128, of_highest = 16;
  return std::max(least, of_highest * highest);
}

}  // namespace

FourierBasis::FourierBasis(const std::size_t highest, const bool only_odd) : only_odd_(only_odd) {
  for (std::size_t k = only_odd ? 1 : 0; k <= highest; k += only_odd ? 2 : 1) orders_.push_back(k);
  const auto n_orders = static_cast<Eigen::Index>(orders_.size());
  const std::size_t period = period_samples(highest);
  const auto n = static_cast<Eigen::Index>(only_odd ? period / 2 : period);
  values_.setZero(n, 2 * n_orders);
  rates_.setZero(n, 2 * n_orders);
  for (Eigen::Index i = 0; i < n_orders; ++i) {
    const double order = static_cast<double>(orders_[static_cast<std::size_t>(i)]);
    const double step = 2. * std::numbers::pi * order / static_cast<double>(period);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double angle = step * static_cast<double>(j);
      values_(j, 2 * i) = std::cos(angle);
      values_(j, 2 * i + 1) = -std::sin(angle);
      rates_(j, 2 * i) = -order * std::sin(angle);
      rates_(j, 2 * i + 1) = -order * std::cos(angle);
    }
  }
  analysis_ = 2. / static_cast<double>(n) * values_.transpose();
  if (!only_odd) analysis_.topRows(2) *= 0.5;
}

LaneRows FourierBasis::samples(const LaneRows& coordinates) const {
  return values_ * coordinates.matrix();
}

LaneRows FourierBasis::rates(const LaneRows& coordinates) const {
  return rates_ * coordinates.matrix();
}

LaneRows FourierBasis::coordinates(const LaneRows& samples) const {
  return analysis_ * samples.matrix();
}

Eigen::VectorXd FourierBasis::converted(const Eigen::VectorXd& coordinates,
                                        const FourierBasis& from) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(n_coordinates());
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    const auto at = std::find(from.orders_.begin(), from.orders_.end(), orders_[i]);
    if (at == from.orders_.end()) continue;
    out.segment<2>(2 * static_cast<Eigen::Index>(i)) =
        coordinates.segment<2>(2 * (at - from.orders_.begin()));
  }
  return out;
}

}  // namespace vibrissa::diagnosis
