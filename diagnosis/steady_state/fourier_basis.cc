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

/// The product by rows: all lanes of a row are one vector, so no blocks need to be packed. Four
/// sums at a time do not wait for one another.
LaneRows product(const Eigen::MatrixXd& matrix, const LaneRows& rows) {
  LaneRows out(matrix.rows(), signals::n_lanes);
  const Eigen::Index n = out.rows(), n_of_four = n - n % 4;
  const auto row = [&](const Eigen::Index j) -> Lanes { return rows.row(j).transpose(); };
  for (Eigen::Index i = 0; i < n_of_four; i += 4) {
    Lanes a = Lanes::Zero(), b = a, c = a, d = a;
    for (Eigen::Index j = 0; j < rows.rows(); ++j) {
      const Lanes factor = row(j);
      const double* const column = &matrix(i, j);
      a += column[0] * factor;
      b += column[1] * factor;
      c += column[2] * factor;
      d += column[3] * factor;
    }
    out.row(i) = a.transpose();
    out.row(i + 1) = b.transpose();
    out.row(i + 2) = c.transpose();
    out.row(i + 3) = d.transpose();
  }
  for (Eigen::Index i = n_of_four; i < n; ++i) {
    Lanes sum = Lanes::Zero();
    for (Eigen::Index j = 0; j < rows.rows(); ++j) sum += matrix(i, j) * row(j);
    out.row(i) = sum.transpose();
  }
  return out;
}

/// cos(2 pi i / n) of i = 0 .. n - 1.
std::vector<double> cosines(const std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = std::cos(2. * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
  return out;
}

}  // namespace

FourierBasis::FourierBasis(const std::size_t highest, const bool only_odd) : only_odd_(only_odd) {
  for (std::size_t k = only_odd ? 1 : 0; k <= highest; k += only_odd ? 2 : 1) orders_.push_back(k);
  const auto n_orders = static_cast<Eigen::Index>(orders_.size());
  const std::size_t period = period_samples(highest);
  const auto n = static_cast<Eigen::Index>(only_odd ? period / 2 : period);
  values_.setZero(n, 2 * n_orders);
  rates_.setZero(n, 2 * n_orders);
  const std::vector<double> cosine = cosines(period);
  for (Eigen::Index i = 0; i < n_orders; ++i) {
    const std::size_t order = orders_[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::size_t turned = order * static_cast<std::size_t>(j);
      values_(j, 2 * i) = cosine[turned % period];
      values_(j, 2 * i + 1) = cosine[(turned + period / 4) % period];
      rates_(j, 2 * i) = static_cast<double>(order) * values_(j, 2 * i + 1);
      rates_(j, 2 * i + 1) = -static_cast<double>(order) * values_(j, 2 * i);
    }
  }
  analysis_ = 2. / static_cast<double>(n) * values_.transpose();
  if (!only_odd) analysis_.topRows(2) *= 0.5;
}

LaneRows FourierBasis::samples(const LaneRows& coordinates) const {
  return product(values_, coordinates);
}

LaneRows FourierBasis::rates(const LaneRows& coordinates) const {
  return product(rates_, coordinates);
}

LaneRows FourierBasis::coordinates(const LaneRows& samples) const {
  return product(analysis_, samples);
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
