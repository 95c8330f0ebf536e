#include "separation/identification/srivc_regression.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "separation/model/mode_step.h"
#include "separation/numerics/all_pole_filter.h"
#include "separation/numerics/levenberg_marquardt.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;
using Signal = Eigen::Map<Eigen::ArrayXd>;
using ConstSignal = Eigen::Map<const Eigen::ArrayXd>;

constexpr Eigen::Index history = 3;

// A signal with zeros before its first sample.
class Padded {
 public:
  explicit Padded(Eigen::Index n) : values_(Eigen::VectorXd::Zero(n + history)) {}
  double* data() { return values_.data() + history; }
  ConstSignal late(Eigen::Index samples) const {
    return {values_.data() + history - samples, values_.size() - history};
  }

 private:
  Eigen::VectorXd values_;
};

Padded filtered(const ModeStep& step, std::span<const double> x) {
  Padded result(static_cast<Eigen::Index>(x.size()));
  AllPoleFilter(step.pole1.value, step.pole2.value)
      .run(x.data(), result.data(), static_cast<std::ptrdiff_t>(x.size()));
  return result;
}

Padded impulse_response(const ModeStep& step, Eigen::Index n) {
  Padded result(n);
  double* g = result.data();
  if (n > 0) g[0] = 1.;
  // A response that has died out is zero: numbers near the smallest double would only cost time.
  for (Eigen::Index i = 1; i < n && std::abs(g[i - 1]) + std::abs(g[i - 2]) > 1e-100; ++i)
    g[i] = -step.pole1.value * g[i - 1] - step.pole2.value * g[i - 2];
  return result;
}

template <std::size_t size, typename Target>
void add_moving_sum(const std::array<Sensitive, size>& taps, double Sensitive::*part, double factor,
                    const Padded& x, Target&& target) {
  for (std::size_t j = 0; j < size; ++j) {
    const double tap = factor * (taps[j].*part);
    if (tap != 0.) target += tap * x.late(static_cast<Eigen::Index>(j));
  }
}

// What drives a mode: its filtered nodes, midpoints, and the response that takes a start at rest
// into account.
struct Drive {
  Padded nodes, midpoints, impulse;
  double first_at_rest = 0.;

  template <typename Target>
  void add(const ModeStep& step, bool rate, double Sensitive::*part, double factor,
           Target&& target) const {
    add_moving_sum(rate ? step.b1_taps : step.b0_taps, part, factor, nodes, target);
    if (midpoints.late(0).size() > 0)
      add_moving_sum(rate ? step.b1_mid : step.b0_mid, part, factor, midpoints, target);
    if (first_at_rest != 0.)
      add_moving_sum(rate ? step.b1_rest : step.b0_rest, part, factor * first_at_rest, impulse,
                     target);
  }
};

// (p1, p0, q1, q0) of s^i (b1 s + b0) / (D D') = (p1 s + p0) / D' + (q1 s + q0) / D, i = 1 for the
// rate; b and D are the mode's, D' the other's.
Eigen::Vector4d separate(const ModalTerm& mode, const ModalTerm& other, bool rate) {
  const double unit = std::sqrt(std::sqrt(mode.a0 * other.a0)), square = unit * unit;
  Eigen::Matrix4d matrix;
  matrix << 1., 0., 1., 0.,                                                  //
      mode.a1 / unit, 1., other.a1 / unit, 1.,                               //
      mode.a0 / square, mode.a1 / unit, other.a0 / square, other.a1 / unit,  //
      0., mode.a0 / square, 0., other.a0 / square;
  const Eigen::Vector4d right =
      rate ? Eigen::Vector4d(0., mode.b1 / unit, mode.b0 / square, 0.)
           : Eigen::Vector4d(0., 0., mode.b1 / square, mode.b0 / (square * unit));
  const Eigen::Vector4d share = matrix.fullPivLu().solve(right);
  return {share[0], unit * share[1], share[2], unit * share[3]};
}

Eigen::VectorXd inverse_length(const Eigen::MatrixXd& columns) {
  Eigen::VectorXd length = columns.colwise().norm();
  for (double& value : length) value = value > 0. ? 1. / value : 1.;
  return length;
}

}  // namespace

SrivcRegression::SrivcRegression(std::size_t n_modes, double delay_s,
                                 std::span<const Segment> segments, double sampling_rate_hz,
                                 const SrivcOptions& options)
    : n_modes_(n_modes),
      sampling_rate_hz_(sampling_rate_hz),
      options_(options),
      delay_(sampled_delay(delay_s, sampling_rate_hz)),
      segments_(align_segments(segments, delay_, options.hold, "SRIVC fit")),
      n_model_(n_parameters(n_modes, options.direct_term)) {
  const Eigen::Index n_nuisance =
      (options.nuisance.initial_state ? 2 * static_cast<Eigen::Index>(n_modes) : 0) +
      (options.nuisance.offset ? 1 : 0);
  const Eigen::Index n_columns =
      n_model_ + n_nuisance * static_cast<Eigen::Index>(segments_.size());
  for (const AlignedSegment& segment : segments_)
    n_rows_ += static_cast<Eigen::Index>(segment.output.size() - segment.first);
  if (n_rows_ < 2 * n_columns)
    throw UserError("SRIVC fit: " + std::to_string(n_rows_) + " samples are too few for " +
                    std::to_string(n_columns) + " unknowns; take a longer record or a lower order");
  instruments_ = Eigen::MatrixXd::Zero(n_rows_, n_columns);
  regressors_ = instruments_;
  simulated_ = Eigen::VectorXd::Zero(n_rows_);
  nuisance_ = Eigen::VectorXd::Zero(n_columns - n_model_);
  measured_.resize(n_rows_);
  Eigen::Index row = 0;
  for (const AlignedSegment& segment : segments_) {
    const auto n = static_cast<Eigen::Index>(segment.output.size() - segment.first);
    measured_.segment(row, n) =
        Eigen::Map<const Eigen::VectorXd>(segment.output.data() + segment.first, n);
    row += n;
  }
}

bool SrivcRegression::admissible(const Bvrm& model) const {
  const double highest = highest_rad_s(options_.hold, sampling_rate_hz_);
  return std::ranges::all_of(model.modes, [&](const ModalTerm& mode) {
    return std::isfinite(mode.a1) && std::isfinite(mode.a0) && is_stable_below(mode, highest);
  });
}

void SrivcRegression::prepare(const Bvrm& model) {
  model_ = model;
  const Eigen::VectorXd before = simulated_;
  simulated_.setZero();
  unexplained_ = measured_;
  const Eigen::Index n_free =
      options_.nuisance.initial_state ? 2 * static_cast<Eigen::Index>(n_modes_) : 0;
  Eigen::Index row = 0, nuisance = n_model_;
  for (const AlignedSegment& segment : segments_) {
    const auto n = static_cast<Eigen::Index>(segment.output.size() - segment.first);
    const Eigen::Map<const Eigen::VectorXd> direct(segment.direct.data() + segment.first, n);
    simulated_.segment(row, n) = model.direct_term_kg_m * direct;
    unexplained_.segment(row, n) -= simulated_.segment(row, n);
    for (std::size_t k = 0; k < n_modes_; ++k)
      fill_instruments(k, model.modes[k], segment, row,
                       n_free > 0 ? nuisance + 2 * static_cast<Eigen::Index>(k) : nuisance);
    if (options_.direct_term) instruments_.col(n_model_ - 1).segment(row, n) = direct;
    if (options_.nuisance.offset) instruments_.col(nuisance + n_free).segment(row, n).setOnes();
    row += n;
    nuisance += n_free + (options_.nuisance.offset ? 1 : 0);
  }
  // All but the denominators' columns are free of noise and serve on both sides.
  for (Eigen::Index j = 0; j < instruments_.cols(); ++j)
    if (j >= 4 * static_cast<Eigen::Index>(n_modes_) || j % 4 < 2)
      regressors_.col(j) = instruments_.col(j);
  Eigen::Index first_row = 0;
  for (const AlignedSegment& segment : segments_) {
    const auto n = static_cast<Eigen::Index>(segment.output.size() - segment.first);
    for (std::size_t k = 0; k < n_modes_; ++k) fill_denominator(k, first_row, n);
    first_row += n;
  }
  movement_ = (simulated_ - before).squaredNorm();
}

void SrivcRegression::fill_instruments(std::size_t k, const ModalTerm& mode,
                                       const AlignedSegment& segment, Eigen::Index first_row,
                                       Eigen::Index first_nuisance) {
  const bool between = lies_between(delay_, options_.hold), free = options_.nuisance.initial_state;
  const auto length = static_cast<Eigen::Index>(segment.output.size());
  const auto first = static_cast<Eigen::Index>(segment.first);
  const Eigen::Index n = length - first;
  const ModeStep step(mode.a1, mode.a0, sampling_rate_hz_, options_.hold,
                      between ? delay_.fraction : 0.);
  const auto used = static_cast<std::size_t>(length);
  const Padded impulse = impulse_response(step, length);
  const Drive input{
      filtered(step, std::span(segment.node).first(used)),
      filtered(step, std::span(segment.midpoint).first(segment.midpoint.empty() ? 0 : used)),
      impulse, free || length == 0 ? 0. : segment.node[0]};
  Eigen::ArrayXXd answer = Eigen::ArrayXXd::Zero(length, 5);  // by b1, b0, a1, a0; the mode's own
  for (const bool rate : {true, false}) {
    const double gain = rate ? mode.b1 : mode.b0;
    input.add(step, rate, &Sensitive::value, 1., answer.col(rate ? 0 : 1));
    input.add(step, rate, &Sensitive::by_a1, gain, answer.col(2));
    input.add(step, rate, &Sensitive::by_a0, gain, answer.col(3));
  }
  answer.col(4) = mode.b1 * answer.col(0) + mode.b0 * answer.col(1);
  simulated_.segment(first_row, n) += answer.matrix().col(4).tail(n);
  for (Eigen::Index j = 0; free && j < 2; ++j) {
    const auto response = impulse.late(j + (between ? 1 : 0));
    instruments_.col(first_nuisance + j).segment(first_row, n) = response.tail(n).matrix();
    answer.col(4) += nuisance_[first_nuisance - n_model_ + j] * response;
  }
  unexplained_.segment(first_row, n) -= answer.matrix().col(4).tail(n);
  const Padded again =
      filtered(step, {answer.col(4).data(), static_cast<std::size_t>(answer.rows())});
  answer.col(2) -= step.pole1.by_a1 * again.late(1) + step.pole2.by_a1 * again.late(2);
  answer.col(3) -= step.pole1.by_a0 * again.late(1) + step.pole2.by_a0 * again.late(2);
  instruments_.block(first_row, 4 * static_cast<Eigen::Index>(k), n, 4) =
      answer.matrix().block(first, 0, n, 4);
}

// -(s, 1) / D_k of the moment. Of the part that the present model explains, its own mode's share is
// the derivative by a1 and a0; the others' follow by partial fractions; what a free response adds
// beyond lies in the columns of the free responses. The rest is filtered as straight lines.
void SrivcRegression::fill_denominator(std::size_t k, Eigen::Index first_row, Eigen::Index n) {
  const auto columns = [&](std::size_t mode, Eigen::Index first) {
    return instruments_.block(first_row, 4 * static_cast<Eigen::Index>(mode) + first, n, 2);
  };
  auto target = regressors_.block(first_row, 4 * static_cast<Eigen::Index>(k) + 2, n, 2);
  target = columns(k, 2) - model_.direct_term_kg_m * columns(k, 0);
  for (std::size_t j = 0; j < n_modes_; ++j) {
    if (j == k) continue;
    for (const bool rate : {true, false}) {
      const Eigen::Vector4d share = separate(model_.modes[j], model_.modes[k], rate);
      target.col(rate ? 0 : 1) -= columns(k, 0) * share.head<2>() + columns(j, 0) * share.tail<2>();
    }
  }
  const ModalTerm& mode = model_.modes[k];
  const ModeStep lines(mode.a1, mode.a0, sampling_rate_hz_, Hold::first_order);
  const std::span<const double> rest(unexplained_.data() + first_row, static_cast<std::size_t>(n));
  const bool at_rest = !options_.nuisance.initial_state && n > 0;
  const Drive output{filtered(lines, rest), Padded(0), impulse_response(lines, n),
                     at_rest ? rest[0] : 0.};
  for (const bool rate : {true, false}) {
    auto column = target.col(rate ? 0 : 1).array();
    output.add(lines, rate, &Sensitive::value, -1., column);
  }
}

Bvrm SrivcRegression::with_best_gains(const Bvrm& model) {
  std::vector<Eigen::Index> linear;
  for (Eigen::Index j = 0; j < instruments_.cols(); ++j)
    if (j >= 4 * static_cast<Eigen::Index>(n_modes_) || j % 4 < 2) linear.push_back(j);
  const Eigen::MatrixXd columns = instruments_(Eigen::all, linear);
  const Eigen::VectorXd scale = inverse_length(columns);
  const Eigen::MatrixXd matrix =
      scale.asDiagonal() * (columns.transpose() * columns) * scale.asDiagonal();
  const Eigen::VectorXd right = scale.cwiseProduct(columns.transpose() * measured_);
  const Eigen::VectorXd gain =
      scale.cwiseProduct(matrix.completeOrthogonalDecomposition().solve(right));
  nuisance_ = gain.tail(nuisance_.size());
  Bvrm result = model;
  for (std::size_t k = 0; k < n_modes_; ++k) {
    result.modes[k].b1 = gain[2 * static_cast<Eigen::Index>(k)];
    result.modes[k].b0 = gain[2 * static_cast<Eigen::Index>(k) + 1];
  }
  result.direct_term_kg_m =
      options_.direct_term ? gain[2 * static_cast<Eigen::Index>(n_modes_)] : 0.;
  return result;
}

SrivcSolution SrivcRegression::solve() {
  const Eigen::VectorXd left = inverse_length(instruments_), right = inverse_length(regressors_);
  const Eigen::MatrixXd matrix =
      left.asDiagonal() * (instruments_.transpose() * regressors_) * right.asDiagonal();
  const Eigen::VectorXd answer = left.cwiseProduct(instruments_.transpose() * measured_);
  const Eigen::VectorXd value =
      right.cwiseProduct(matrix.completeOrthogonalDecomposition().solve(answer));
  nuisance_ = value.tail(nuisance_.size());
  SrivcSolution solution{.modes = model_.modes,
                         .denominator = Eigen::VectorXd(2 * static_cast<Eigen::Index>(n_modes_)),
                         .direct_term = options_.direct_term ? value[n_model_ - 1] : 0.,
                         .cost = (measured_ - regressors_ * value).squaredNorm()};
  for (std::size_t k = 0; k < n_modes_; ++k) {
    const auto column = 4 * static_cast<Eigen::Index>(k), c = 2 * static_cast<Eigen::Index>(k);
    solution.modes[k].b1 = value[column];
    solution.modes[k].b0 = value[column + 1];
    solution.denominator.segment<2>(c) = value.segment<2>(column + 2);
  }
  return solution;
}

Eigen::MatrixXd SrivcRegression::inverse_information() const {
  const Eigen::MatrixXd inverse =
      separation::inverse_information(instruments_.transpose() * instruments_);
  return inverse.size() == 0 ? inverse : Eigen::MatrixXd(inverse.topLeftCorner(n_model_, n_model_));
}

}  // namespace vibrissa::separation
