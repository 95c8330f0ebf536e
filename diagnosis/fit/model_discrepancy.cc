#include "diagnosis/fit/model_discrepancy.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// Terms that are proportional to the prediction: constant and slope within a block.
constexpr Eigen::Index n_of_prediction = 2;
constexpr double slope_share = 0.5;

/// Edges of the blocks from the lowest to the highest evaluated frequency [Hz].
std::vector<double> block_edges(const Experiment& experiment) {
  const double octave_part = std::exp2(1. / 6.) - 1.;
  double low = 1e300, high = 0.;
  for (const PreparedRecord& record : experiment.records) {
    if (record_kind(record) == n_record_kinds) continue;
    low = std::min(low, record.bin_hz());
    high = std::max(high, record.bin_hz() * static_cast<double>(record.n_bins() + 1));
  }
  const double lowest =
      experiment.scales.first_mode_rad_s / (2. * std::numbers::pi) / 32.;  // five octaves below
  std::vector<double> edges{std::max(low, lowest)};
  while (edges.back() < high) {
    const double f = edges.back();
    double width = octave_part * f;
    for (const StructuralMode& mode : experiment.nominal.modes) {
      const double f0 = mode.frequency_rad_s / (2. * std::numbers::pi),
                   third = 2. * mode.damping_ratio * f0 / 3.;
      width = std::min(width, std::max(third, std::abs(f - f0) / 3.));
    }
    edges.push_back(f + std::max(width, low));
  }
  return edges;
}

}  // namespace

std::size_t record_kind(const PreparedRecord& record) {
  const bool base = record.excitation.base, wind = record.excitation.wind;
  return base && wind ? 2 : wind ? 1 : base ? 0 : n_record_kinds;
}

ModelDiscrepancy::ModelDiscrepancy(const Experiment& experiment) {
  const std::vector<double> edges = block_edges(experiment);
  std::map<std::pair<std::size_t, std::size_t>, int> known;  // (kind, interval) -> block
  for (const PreparedRecord& record : experiment.records) {
    const std::size_t kind = record_kind(record);
    for (std::size_t b = 0; b < record.n_bins(); ++b) {
      position_.push_back(0.);
      block_.push_back(-1);
      if (kind == n_record_kinds) continue;
      const double f = record.bin_hz() * static_cast<double>(b + 1);
      const auto above =
          static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), f) - edges.begin());
      const auto [found, is_new] =
          known.try_emplace({kind, above}, static_cast<int>(kind_of_block_.size()));
      if (is_new) kind_of_block_.push_back(kind);
      block_.back() = found->second;
      if (above > 0 && above < edges.size())
        position_.back() = 2. * (f - edges[above - 1]) / (edges[above] - edges[above - 1]) - 1.;
    }
  }
}

ModelDiscrepancy::Solution ModelDiscrepancy::solve(const Eigen::VectorXcd& error,
                                                   const Eigen::VectorXd& per_deviation,
                                                   const std::array<double, n_record_kinds>& delta,
                                                   const double level) const {
  Solution out;
  out.of_ = this;
  const Eigen::Index n_terms = n_of_prediction + shapes_.changes.cols();
  out.whitened_.setZero(n_rows(), n_terms);
  out.inverse_.assign(n_blocks(), Eigen::MatrixXcd::Zero(n_terms, n_terms));
  out.weights_.assign(n_blocks(), Eigen::VectorXcd::Zero(n_terms));
  for (Eigen::Index row = 0; row < n_rows(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    if (block_[i] < 0) continue;
    const auto k = static_cast<std::size_t>(block_[i]);
    auto u = out.whitened_.row(row);
    u(0) = delta[kind_of_block_[k]] * per_deviation(row) * shapes_.mean(row);
    u(1) = slope_share * position_[i] * u(0);
    u.tail(n_terms - n_of_prediction) = level * per_deviation(row) * shapes_.changes.row(row);
    for (Eigen::Index a = 0; a < n_terms; ++a) {
      const Complex conjugate = std::conj(u(a));
      out.weights_[k](a) += conjugate * error(row);
      for (Eigen::Index b = 0; b <= a; ++b) out.inverse_[k](a, b) += conjugate * u(b);
    }
  }
  const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(n_terms, n_terms);
  for (std::size_t k = 0; k < n_blocks(); ++k) {
    const Eigen::MatrixXcd gram = out.inverse_[k].selfadjointView<Eigen::Lower>();
    const Eigen::LLT<Eigen::MatrixXcd> llt(identity + gram);
    const Eigen::VectorXcd products = out.weights_[k];
    out.inverse_[k] = llt.solve(identity);
    out.weights_[k] = out.inverse_[k] * products;
    out.gain_ += products.dot(out.weights_[k]).real() -
                 2. * Eigen::MatrixXcd(llt.matrixL()).diagonal().real().array().log().sum();
    const Eigen::MatrixXcd share = out.inverse_[k] * gram;
    for (Eigen::Index a = 0; a < n_terms; ++a) {
      const std::size_t kind = a < n_of_prediction ? kind_of_block_[k] : n_record_kinds;
      const double of_variance = 2. * share(a, a).real();
      out.gradient_[kind] += 2. * std::norm(out.weights_[k](a)) - of_variance;
      out.information_[kind] += of_variance * of_variance;
    }
  }
  return out;
}

Eigen::VectorXcd ModelDiscrepancy::Solution::mean() const {
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(whitened_.rows());
  for (Eigen::Index row = 0; row < out.size(); ++row)
    if (const int k = of_->block_[static_cast<std::size_t>(row)]; k >= 0)
      out(row) = (whitened_.row(row) * weights_[static_cast<std::size_t>(k)]).value();
  return out;
}

Eigen::VectorXd ModelDiscrepancy::Solution::leverage() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(whitened_.rows());
  for (Eigen::Index row = 0; row < out.size(); ++row)
    if (const int k = of_->block_[static_cast<std::size_t>(row)]; k >= 0)
      out(row) = (whitened_.row(row) * inverse_[static_cast<std::size_t>(k)])
                     .dot(whitened_.row(row))
                     .real();
  return out;
}

void ModelDiscrepancy::Solution::project(const Eigen::MatrixXd& columns, Eigen::VectorXd& gradient,
                                         Eigen::MatrixXd& information) const {
  const Eigen::Index n = columns.cols(), n_terms = whitened_.cols();
  std::vector<Eigen::MatrixXcd> products(inverse_.size(), Eigen::MatrixXcd::Zero(n_terms, n));
  for (Eigen::Index row = 0; row < whitened_.rows(); ++row) {
    const int k = of_->block_[static_cast<std::size_t>(row)];
    if (k < 0) continue;
    Eigen::MatrixXcd& sum = products[static_cast<std::size_t>(k)];
    for (Eigen::Index c = 0; c < n; ++c) {
      const Complex value(columns(2 * row, c), columns(2 * row + 1, c));
      for (Eigen::Index a = 0; a < n_terms; ++a) sum(a, c) += std::conj(whitened_(row, a)) * value;
    }
  }
  for (std::size_t k = 0; k < products.size(); ++k) {
    gradient -= 2. * (products[k].adjoint() * weights_[k]).real();
    information -= 2. * (products[k].adjoint() * inverse_[k] * products[k]).real();
  }
}

Eigen::VectorXcd ModelDiscrepancy::Solution::apply_inverse(const Eigen::VectorXcd& column) const {
  std::vector<Eigen::VectorXcd> overlap(inverse_.size(), Eigen::VectorXcd::Zero(whitened_.cols()));
  const auto block_of = [&](Eigen::Index row) {
    return of_->block_[static_cast<std::size_t>(row)];
  };
  for (Eigen::Index row = 0; row < column.size(); ++row)
    if (const int k = block_of(row); k >= 0)
      overlap[static_cast<std::size_t>(k)] += whitened_.row(row).adjoint() * column(row);
  for (std::size_t k = 0; k < overlap.size(); ++k) overlap[k] = inverse_[k] * overlap[k];
  Eigen::VectorXcd out = column;
  for (Eigen::Index row = 0; row < column.size(); ++row)
    if (const int k = block_of(row); k >= 0)
      out(row) -= (whitened_.row(row) * overlap[static_cast<std::size_t>(k)]).value();
  return out;
}

}  // namespace vibrissa::diagnosis
