#include "trial/generator/signature.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "trial/generator/calibration_draw.h"
#include "trial/generator/unknowns.h"

namespace vibrissa::trial {
namespace {

void scale(LineChange& change, const double factor) {
  for (std::complex<double>& x : change.moment) x *= factor;
  for (double& x : change.wind_power) x *= factor;
}

/// Weights of the lines about each of a series of frequencies: triangles over the logarithm of
/// frequency, a sixth of an octave apart.
std::vector<std::vector<double>> neighbourhoods(const std::vector<double>& frequencies_hz) {
  constexpr double width = 1. / 6.;
  const auto [low, high] = std::ranges::minmax(frequencies_hz);
  std::vector<std::vector<double>> out;
  for (double octave = std::log2(low); octave < std::log2(high) + width; octave += width) {
    std::vector<double>& weights = out.emplace_back();
    for (const double hz : frequencies_hz)
      weights.push_back(std::max(0., 1. - std::abs(std::log2(hz) - octave) / width));
  }
  return out;
}

/// Relative error of a moment, smooth over frequency.
void add_relative_error(std::vector<LineChange>& out, const double accuracy,
                        const std::vector<std::complex<double>>& moment,
                        const std::vector<double>& frequencies_hz) {
  for (const std::vector<double>& weights : neighbourhoods(frequencies_hz)) {
    LineChange part{.moment = moment};
    std::ranges::transform(moment, weights, part.moment.begin(), std::multiplies<>{});
    const auto is_there = [](const std::complex<double>& x) { return x != 0.; };
    if (std::ranges::none_of(part.moment, is_there)) continue;
    for (const std::complex<double> phase : {std::complex(1., 0.), std::complex(0., 1.)}) {
      LineChange& error = out.emplace_back(part);
      for (std::complex<double>& x : error.moment) x *= accuracy / std::numbers::sqrt2 * phase;
    }
  }
}

/// Nobody knows the spectrum of a wind that was not measured: it may be any smooth one.
void add_unseen_wind(std::vector<LineChange>& out, const UnexplainedChange& change) {
  constexpr double any = 1e3;
  const std::vector<double>& power = change.unseen_wind();
  if (power.empty()) return;
  for (const std::vector<double>& weights : neighbourhoods(change.frequencies_hz())) {
    LineChange& error = out.emplace_back();
    error.moment.resize(power.size());
    std::ranges::transform(power, weights, std::back_inserter(error.wind_power),
                           [](double p, double weight) { return any * p * weight; });
  }
}

}  // namespace

LineChange change_of(const UnexplainedChange& change, const World& world, const bool random) {
  return {.moment = change.of(world, random),
          .wind_power = random ? std::vector<double>{} : change.of_wind_power(world),
          .random = random};
}

Eigen::VectorXd signature_of(const LineChange& change, const std::vector<double>& noise) {
  const auto n = static_cast<Eigen::Index>(change.moment.size());
  Eigen::VectorXd out = Eigen::VectorXd::Zero(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto line = static_cast<std::size_t>(i);
    const std::complex<double> x = change.moment[line];
    const double variance = noise[line];
    if (change.random) {
      // The estimate of a variance from one draw has a variance of twice its square.
      out[2 * n + i] = std::norm(x) / variance / std::numbers::sqrt2;
    } else {
      out[i] = std::numbers::sqrt2 * x.real() / std::sqrt(variance);
      out[n + i] = std::numbers::sqrt2 * x.imag() / std::sqrt(variance);
    }
    if (!change.wind_power.empty())
      out[2 * n + i] += change.wind_power[line] / variance / std::numbers::sqrt2;
  }
  return out;
}

std::vector<LineChange> unknown_changes(const UnexplainedChange& change, const Distance distance,
                                        const double accuracy) {
  // Small enough for a linear response.
  constexpr double small = 0.2;
  std::vector<LineChange> out;
  for (const auto& [id, deviation] : calibration_deviations(distance)) {
    World world = change.plain();
    find_unknown(id).apply(world, small * deviation, 0.5);
    scale(out.emplace_back(change_of(change, world, false)), 1. / small);
  }
  add_unseen_wind(out, change);
  if (accuracy == 0.) return out;
  for (const std::vector<std::complex<double>>& moment : {change.by_base(), change.by_wind()})
    add_relative_error(out, accuracy, moment, change.frequencies_hz());
  return out;
}

WidenedNoise::WidenedNoise(const std::vector<LineChange>& unknown,
                           const std::vector<double>& noise) {
  if (unknown.empty()) return;
  const auto m = static_cast<Eigen::Index>(unknown.size());
  Eigen::MatrixXd spread(3 * static_cast<Eigen::Index>(noise.size()), m);
  for (Eigen::Index i = 0; i < m; ++i)
    spread.col(i) = signature_of(unknown[static_cast<std::size_t>(i)], noise);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(spread);
  const Eigen::MatrixXd root = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(root * root.transpose());
  directions_ = qr.householderQ() * Eigen::MatrixXd::Identity(spread.rows(), m);
  directions_ *= parts.eigenvectors();
  lost_ = 1. - (1. + parts.eigenvalues().cwiseMax(0.).array()).rsqrt();
}

Eigen::MatrixXd WidenedNoise::whitened(const Eigen::MatrixXd& signatures) const {
  if (lost_.size() == 0) return signatures;
  return signatures - directions_ * (lost_.asDiagonal() * (directions_.transpose() * signatures));
}

}  // namespace vibrissa::trial
