#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnosis/model/chain.h"

namespace vibrissa::diagnosis {

/// Eight vectors or signals side by side: one row for each coordinate or sample.
using LaneRows = Eigen::Array<double, Eigen::Dynamic, signals::n_lanes, Eigen::RowMajor>;

/// The harmonics of real periodic signals, x(t) = Re sum_k X_k exp(j k w t). The coordinates of a
/// signal are Re X_k and Im X_k of each order in turn; Im X_0 has no meaning. Odd orders alone
/// describe a signal whose second half period is the negative of the first. Proven by
/// tests/diagnosis/steady_state/fourier_basis_test.cc.
class FourierBasis {
 public:
  /// Orders 1, 3 .. highest, or 0, 1, 2 .. highest.
  FourierBasis(std::size_t highest, bool only_odd);

  bool only_odd() const { return only_odd_; }
  const std::vector<std::size_t>& orders() const { return orders_; }
  std::size_t highest() const { return orders_.back(); }
  /// Index of the first coordinate of the fundamental.
  Eigen::Index fundamental() const { return only_odd_ ? 0 : 2; }
  Eigen::Index n_coordinates() const { return analysis_.rows(); }
  /// Samples of a period, or of its first half where all orders are odd.
  Eigen::Index n_samples() const { return analysis_.cols(); }
  std::size_t n_samples_of_period() const {
    return static_cast<std::size_t>(n_samples()) * (only_odd_ ? 2 : 1);
  }

  /// Samples of the signals, and of their rates divided by w.
  LaneRows samples(const LaneRows& coordinates) const;
  LaneRows rates(const LaneRows& coordinates) const;
  /// Coordinates of samples (discrete Fourier transform).
  LaneRows coordinates(const LaneRows& samples) const;
  /// The coordinates in other harmonics; missing orders are zero.
  Eigen::VectorXd converted(const Eigen::VectorXd& coordinates, const FourierBasis& from) const;

 private:
  bool only_odd_;
  std::vector<std::size_t> orders_;
  Eigen::MatrixXd values_, rates_, analysis_;
};

}  // namespace vibrissa::diagnosis
