#include "diagnosis/fit/model_discrepancy.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// Terms of the simulation: in proportion to the prediction, constant and slope within a block; and
/// the residual of the modes above, which differs little from block to block.
constexpr Eigen::Index n_of_simulation = 3;
constexpr double slope_share = 0.5, residual_share = 0.1;

/// Edges of the blocks from the lowest to the highest evaluated frequency [Hz].
std::vector<double> block_edges(const Experiment& experiment) {
  const double octave_part = std::exp2(1. / 6.) - 1.;
  double low = 1e300, high = 0.;
  for (const PreparedRecord& record : experiment.records) {
    if (record_kind(record) == n_record_kinds) continue;
    low = std::min(low, record.bin_hz());
    high = std::max(high, record.frequency_hz(record.n_bins() - 1) + record.bin_hz());
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

/// One hat function for each octave, without their mean, which is a gain: at a frequency [Hz]
/// between edges.
Eigen::VectorXd wide_forms(const std::vector<double>& edges, const double hz) {
  const double octaves = std::log2(edges.back() / edges.front()),
               x = std::clamp(std::log2(hz / edges.front()), 0., octaves);
  Eigen::VectorXd out(static_cast<Eigen::Index>(std::ceil(octaves)) + 1);
  for (Eigen::Index m = 0; m < out.size(); ++m)
    out(m) = std::max(0., 1. - std::abs(x - static_cast<double>(m)));
  return out.array() - out.mean();
}

/// The wide forms of each kind of record and the residual as terms within a block of one kind.
Eigen::MatrixXd wide_forms_of_block(const std::vector<double>& edges, const std::size_t above,
                                    const std::size_t kind) {
  const std::size_t last = edges.size() - 1;
  const Eigen::VectorXd left = wide_forms(edges, edges[std::min(above == 0 ? 0 : above - 1, last)]),
                        right = wide_forms(edges, edges[std::min(above, last)]);
  const auto n_kinds = static_cast<Eigen::Index>(n_record_kinds);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n_of_simulation, n_kinds * left.size() + 1);
  auto of_kind = out.middleCols(static_cast<Eigen::Index>(kind) * left.size(), left.size());
  of_kind.row(0) = 0.5 * (left + right);
  of_kind.row(1) = 0.5 / slope_share * (right - left);
  out(2, out.cols() - 1) = 1. / residual_share;
  return out;
}

/// The quasi-static moment of the base motion at the evaluated bins of all records; 0 for a
/// simulation without modes, where it is a gain.
std::vector<Complex> quasi_static(const Experiment& experiment) {
  const double gain = experiment.nominal.modes.empty() ? 0. : experiment.scales.static_gain;
  std::vector<Complex> out;
  for (const PreparedRecord& record : experiment.records) {
    std::vector<Complex> bins(record.n_bins());
    if (!record.acceleration.empty()) bins = bins_of_lines(record, record.acceleration);
    for (const Complex& value : bins) out.push_back(gain * value);
  }
  return out;
}

/// The wide forms of each kind, then the residual of missing modes.
std::size_t level_of_form(const Eigen::Index form, const Eigen::Index n_forms) {
  const auto n_kinds = static_cast<Eigen::Index>(n_record_kinds);
  return static_cast<std::size_t>(n_kinds + form / ((n_forms - 1) / n_kinds));
}

/// Logarithm of the determinant of a Hermitian matrix.
double log_determinant(const Eigen::LLT<Eigen::MatrixXcd>& llt) {
  return 2. * llt.matrixLLT().diagonal().real().array().log().sum();
}

}  // namespace

std::size_t record_kind(const PreparedRecord& record) {
  const bool base = record.excitation.base, wind = record.excitation.wind;
  return base && wind ? 2 : wind ? 1 : base ? 0 : n_record_kinds;
}

ModelDiscrepancy::ModelDiscrepancy(const Experiment& experiment)
    : quasi_static_(quasi_static(experiment)) {
  const std::vector<double> edges = block_edges(experiment);
  std::map<std::pair<std::size_t, std::size_t>, int> known;  // (kind, interval) -> block
  for (const PreparedRecord& record : experiment.records) {
    const std::size_t kind = record_kind(record);
    for (std::size_t b = 0; b < record.n_bins(); ++b) {
      position_.push_back(0.);
      block_.push_back(-1);
      if (kind == n_record_kinds) continue;
      const double f = record.frequency_hz(b);
      const auto above =
          static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), f) - edges.begin());
      const auto [found, is_new] =
          known.try_emplace({kind, above}, static_cast<int>(kind_of_block_.size()));
      if (is_new) {
        kind_of_block_.push_back(kind);
        wide_.push_back(wide_forms_of_block(edges, above, kind));
      }
      block_.back() = found->second;
      if (above > 0 && above < edges.size())
        position_.back() = 2. * (f - edges[above - 1]) / (edges[above] - edges[above - 1]) - 1.;
    }
  }
  for (Eigen::Index row = 0; row < n_rows(); ++row) {
    if (block(row) < 0) continue;
    const auto k = static_cast<std::size_t>(block(row));
    if (row > 0 && block(row) == block(row - 1))
      ++segments_.back().n;
    else
      segments_.push_back({.block = k, .first = row, .n = 1});
  }
}

/// The wide forms, in units of the block's own terms: terms x forms.
Eigen::MatrixXd ModelDiscrepancy::forms_of_block(const std::size_t block,
                                                 const DiscrepancyLevels& levels) const {
  const std::size_t kind = kind_of_block_[block];
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(n_of_simulation + shapes_.changes.cols(), wide_[block].cols());
  for (Eigen::Index m = 0; m < out.cols(); ++m)
    out.col(m).head<n_of_simulation>() =
        levels[level_of_form(m, out.cols())] / levels[kind] * wide_[block].col(m);
  return out;
}

Eigen::MatrixXd ModelDiscrepancy::prior_covariance(const int a, const int b,
                                                   const DiscrepancyLevels& levels) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  const Eigen::MatrixXd left = forms_of_block(i, levels), right = forms_of_block(j, levels);
  Eigen::MatrixXd out = left * right.transpose();
  if (a == b) out.diagonal().array() += 1.;
  return out;
}

ModelDiscrepancy::Solution ModelDiscrepancy::solve(const Eigen::VectorXcd& error,
                                                   const Eigen::VectorXd& per_deviation,
                                                   const DiscrepancyLevels& levels) const {
  Solution out;
  out.of_ = this;
  const Eigen::Index n_terms = n_of_simulation + shapes_.changes.cols();
  out.whitened_.setZero(n_rows(), n_terms);
  for (const Segment& s : segments_)
    for (Eigen::Index row = s.first; row < s.first + s.n; ++row) {
      auto u = out.whitened_.row(row);
      u(0) = levels[kind_of_block_[s.block]] * per_deviation(row) * shapes_.mean(row);
      u(1) = slope_share * position_[static_cast<std::size_t>(row)] * u(0);
      u(2) = residual_share * levels[kind_of_block_[s.block]] * per_deviation(row) *
             quasi_static_[static_cast<std::size_t>(row)];
      u.tail(n_terms - n_of_simulation) =
          levels[index_of_form_level] * per_deviation(row) * shapes_.changes.row(row);
    }
  out.invert(levels);
  const Solution::PerBlock products = out.overlap(error);
  out.weights_ = out.amplitudes(products);
  for (std::size_t k = 0; k < n_blocks(); ++k)
    out.gain_ += (products[k].adjoint() * out.weights_[k]).value().real();
  out.add_gradient(out.wide_amplitudes(products));
  return out;
}

void ModelDiscrepancy::Solution::invert(const DiscrepancyLevels& levels) {
  const Eigen::Index n_terms = whitened_.cols(),
                     n_wide = of_->wide_.empty() ? 0 : of_->wide_.front().cols();
  const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(n_terms, n_terms),
                         wide_identity = Eigen::MatrixXcd::Identity(n_wide, n_wide);
  Eigen::MatrixXcd wide_precision = wide_identity;
  PerBlock gram = overlap(whitened_);
  for (std::size_t k = 0; k < gram.size(); ++k) {
    const Eigen::LLT<Eigen::MatrixXcd> llt(identity + gram[k]);
    gain_ -= log_determinant(llt);
    inverse_.push_back(llt.solve(identity));
    forms_.push_back(of_->forms_of_block(k, levels));
    wide_.push_back(inverse_[k] * forms_[k]);
    wide_precision += wide_[k].adjoint() * gram[k] * forms_[k];
  }
  const Eigen::LLT<Eigen::MatrixXcd> llt(wide_precision);
  gain_ -= log_determinant(llt);
  wide_covariance_ = llt.solve(wide_identity);
}

void ModelDiscrepancy::Solution::add_gradient(const Eigen::VectorXcd& wide_weights) {
  const auto add = [&](const std::size_t level, const Complex weight, const double share) {
    gradient_[level] += 2. * std::norm(weight) - 2. * share;
    information_[level] += 4. * share * share;
  };
  for (std::size_t k = 0; k < inverse_.size(); ++k) {
    const std::size_t kind = of_->kind_of_block_[k];
    // What the wide forms leave to the block's own amplitudes.
    const Eigen::MatrixXcd seen = forms_[k] - wide_[k];
    const Eigen::VectorXcd own = weights_[k] - forms_[k] * wide_weights;
    for (Eigen::Index a = 0; a < own.size(); ++a)
      add(a < n_of_simulation ? kind : index_of_form_level, own(a),
          1. - inverse_[k](a, a).real() -
              (seen.row(a) * wide_covariance_ * seen.row(a).adjoint()).value().real());
  }
  for (Eigen::Index m = 0; m < wide_weights.size(); ++m)
    add(level_of_form(m, wide_weights.size()), wide_weights(m), 1. - wide_covariance_(m, m).real());
}

ModelDiscrepancy::Solution::PerBlock ModelDiscrepancy::Solution::overlap(
    const Columns& columns) const {
  PerBlock out(of_->n_blocks(), Eigen::MatrixXcd::Zero(whitened_.cols(), columns.cols()));
  for (const Segment& s : of_->segments_)
    out[s.block] += whitened_.middleRows(s.first, s.n).adjoint() * columns.middleRows(s.first, s.n);
  return out;
}

Eigen::MatrixXcd ModelDiscrepancy::Solution::wide_amplitudes(const PerBlock& overlap) const {
  Eigen::MatrixXcd products =
      Eigen::MatrixXcd::Zero(wide_covariance_.rows(), overlap.empty() ? 0 : overlap.front().cols());
  for (std::size_t k = 0; k < overlap.size(); ++k) products += wide_[k].adjoint() * overlap[k];
  return wide_covariance_ * products;
}

ModelDiscrepancy::Solution::PerBlock ModelDiscrepancy::Solution::amplitudes(
    const PerBlock& overlap) const {
  const Eigen::MatrixXcd wide = wide_amplitudes(overlap);
  PerBlock out;
  for (std::size_t k = 0; k < overlap.size(); ++k)
    out.push_back(inverse_[k] * overlap[k] + wide_[k] * wide);
  return out;
}

Eigen::VectorXcd ModelDiscrepancy::Solution::mean() const {
  Eigen::VectorXcd out = Eigen::VectorXcd::Zero(whitened_.rows());
  for (const Segment& s : of_->segments_)
    out.segment(s.first, s.n) = whitened_.middleRows(s.first, s.n) * weights_[s.block];
  return out;
}

Eigen::VectorXd ModelDiscrepancy::Solution::leverage() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(whitened_.rows());
  for (const Segment& s : of_->segments_) {
    const auto u = whitened_.middleRows(s.first, s.n);
    const Eigen::MatrixXcd& wide = wide_[s.block];
    const Eigen::MatrixXcd covariance =
        inverse_[s.block] + wide * wide_covariance_ * wide.adjoint();
    out.segment(s.first, s.n) = (u * covariance).cwiseProduct(u.conjugate()).rowwise().sum().real();
  }
  return out;
}

void ModelDiscrepancy::Solution::project(const Eigen::MatrixXd& columns, Eigen::VectorXd& gradient,
                                         Eigen::MatrixXd& information) const {
  // Real and imaginary parts in turn are complex numbers.
  const Eigen::Map<const Eigen::MatrixXcd> complex_columns(
      reinterpret_cast<const Complex*>(columns.data()), whitened_.rows(), columns.cols());
  const PerBlock products = overlap(complex_columns), explained = amplitudes(products);
  for (std::size_t k = 0; k < products.size(); ++k) {
    gradient -= 2. * (products[k].adjoint() * weights_[k]).real();
    information -= 2. * (products[k].adjoint() * explained[k]).real();
  }
}

Eigen::VectorXcd ModelDiscrepancy::Solution::apply_inverse(const Eigen::VectorXcd& column) const {
  const PerBlock explained = amplitudes(overlap(column));
  Eigen::VectorXcd out = column;
  for (const Segment& s : of_->segments_)
    out.segment(s.first, s.n) -= whitened_.middleRows(s.first, s.n) * explained[s.block];
  return out;
}

}  // namespace vibrissa::diagnosis
