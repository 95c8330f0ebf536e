#include "separation/ringdown/decay_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "signals/spectra/fft.h"

namespace vibrissa::separation {

namespace {

using Spans = std::span<const std::span<const double>>;
/// Of each piece: moment, rate, offset, drift, and with friction its state.
constexpr Eigen::Index n_moments = 4;
Eigen::Index n_of_start(const LawParts& parts) {
  return n_moments + parts.friction;
}

Eigen::VectorXd parameters_of(const DecayLaw& law, const LawParts& parts) {
  std::vector<double> x{std::log(law.frequency_hz), std::log(law.damping_ratio)};
  if (parts.cubic) x.push_back(law.cubic);
  if (parts.drag) x.push_back(std::log(law.drag));
  if (parts.friction) {
    x.push_back(std::log(law.slip));
    x.push_back(std::log(law.stick_ratio));
  }
  return Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

double largest(std::span<const double> x) {
  double out = 0.;
  for (const double value : x) out = std::max(out, std::abs(value));
  return out;
}

/// Error of all pieces and its derivatives, by differences.
class DecayProblem {
 public:
  DecayProblem(const DecayLaw& structure, const LawParts& parts, Spans pieces, double rate_hz)
      : structure_(structure), parts_(parts), pieces_(pieces), rate_hz_(rate_hz) {
    for (const std::span<const double> piece : pieces)
      largest_ = std::max(largest_, largest(piece));
  }

  Eigen::Index n_law() const { return parts_.n_parameters(); }
  /// Index of the first unknown of a piece.
  Eigen::Index first_of(std::size_t piece) const {
    return n_law() + n_of_start(parts_) * static_cast<Eigen::Index>(piece);
  }

  DecayStart start_of(const Eigen::VectorXd& unknowns, std::size_t piece) const {
    const Eigen::Index at = first_of(piece);
    return {.moment = unknowns[at],
            .rate = unknowns[at + 1],
            .friction = parts_.friction ? std::tanh(unknowns[at + n_moments]) : 0.,
            .offset = unknowns[at + 2],
            .drift = unknowns[at + 3]};
  }

  std::vector<double> error(const Eigen::VectorXd& unknowns, std::size_t piece) const {
    std::vector<double> out = decay(with_parameters(structure_, parts_, unknowns.head(n_law())),
                                    start_of(unknowns, piece), pieces_[piece].size(), rate_hz_);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = pieces_[piece][i] - out[i];
    return out;
  }

  bool linearise(const Eigen::VectorXd& unknowns, NormalEquations& equations) const {
    if (!admissible(unknowns)) return false;
    equations = {.matrix = Eigen::MatrixXd::Zero(unknowns.size(), unknowns.size()),
                 .gradient = Eigen::VectorXd::Zero(unknowns.size())};
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      add_piece(unknowns, p, equations);
      if (parts_.friction) add_prior(unknowns, p, equations);
    }
    return std::isfinite(equations.cost) && equations.matrix.allFinite();
  }

 private:
  bool admissible(const Eigen::VectorXd& unknowns) const {
    constexpr double most_damping = 0.7, highest_share = 0.45, most_stick = 100.;
    const DecayLaw law = with_parameters(structure_, parts_, unknowns.head(n_law()));
    const double bent = law.cubic * largest_ * largest_;
    return law.damping_ratio < most_damping && law.frequency_hz < highest_share * rate_hz_ &&
           law.stick_ratio < most_stick && law.slip <= largest_ && bent > -0.5 && bent < 10.;
  }

  double step_of(Eigen::Index i) const {
    constexpr double relative = 1e-6;
    if (i >= n_law())
      return relative * ((i - n_law()) % n_of_start(parts_) < n_moments ? largest_ : 1.);
    return parts_.is_logarithm(i) ? relative : relative / (largest_ * largest_);
  }

  /// Of friction that slips at first, the state has no slope: its coordinate is about 0 to 2, at a
  /// noise of a thousandth.
  void add_prior(const Eigen::VectorXd& unknowns, std::size_t piece,
                 NormalEquations& equations) const {
    constexpr double usual = 2., noise = 1e-3;
    const double weight = std::pow(noise * largest_ / usual, 2);
    const Eigen::Index i = first_of(piece) + n_moments;
    equations.matrix(i, i) += weight;
    equations.gradient[i] -= weight * unknowns[i];
    equations.cost += weight * unknowns[i] * unknowns[i];
  }

  void add_piece(const Eigen::VectorXd& unknowns, std::size_t piece,
                 NormalEquations& equations) const {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index i = 0; i < n_law(); ++i) columns.push_back(i);
    for (Eigen::Index i = 0; i < n_of_start(parts_); ++i) columns.push_back(first_of(piece) + i);
    const std::vector<double> here = error(unknowns, piece);
    const auto n = static_cast<Eigen::Index>(here.size());
    const Eigen::Map<const Eigen::VectorXd> e(here.data(), n);
    Eigen::MatrixXd slopes(n, static_cast<Eigen::Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      Eigen::VectorXd moved = unknowns;
      const double h = step_of(columns[k]);
      moved[columns[k]] += h;
      const std::vector<double> there = error(moved, piece);
      slopes.col(static_cast<Eigen::Index>(k)) =
          (e - Eigen::Map<const Eigen::VectorXd>(there.data(), n)) / h;
    }
    equations.matrix(columns, columns) += slopes.transpose() * slopes;
    equations.gradient(columns) += slopes.transpose() * e;
    equations.cost += e.squaredNorm();
  }

  const DecayLaw& structure_;
  const LawParts& parts_;
  Spans pieces_;
  double rate_hz_, largest_ = 0.;
};

/// State of a linear mode that fits the first period of a piece.
DecayStart first_state(const DecayLaw& law, std::span<const double> piece, double rate_hz) {
  const double w = 2. * std::numbers::pi * law.frequency_hz / rate_hz;
  const auto n = static_cast<Eigen::Index>(
      std::min(static_cast<double>(piece.size()), std::ceil(2. * std::numbers::pi / w)));
  constexpr Eigen::Index n_shapes = 3;
  Eigen::MatrixXd shapes(n, n_shapes);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = w * static_cast<double>(i);
    shapes.row(i) << std::cos(angle), std::sin(angle), 1.;
  }
  const Eigen::Map<const Eigen::VectorXd> measured(piece.data(), n);
  const Eigen::VectorXd x = shapes.colPivHouseholderQr().solve(measured);
  return {.moment = x[0], .rate = x[1], .offset = x[2]};
}

/// Mean power of the errors within a third of the frequency, over that of all lines; at least 1.
double colour_at(const std::vector<std::vector<double>>& errors, double frequency_hz,
                 double rate_hz) {
  double near = 0., all = 0., n_near = 0., n_all = 0.;
  for (const std::vector<double>& error : errors) {
    const std::vector<std::complex<double>> lines = signals::real_fft(error);
    for (std::size_t k = 1; k < lines.size(); ++k) {
      const double hz = static_cast<double>(k) * rate_hz / static_cast<double>(error.size());
      all += std::norm(lines[k]);
      n_all += 1.;
      if (std::abs(hz / frequency_hz - 1.) > 1. / 3.) continue;
      near += std::norm(lines[k]);
      n_near += 1.;
    }
  }
  return n_near > 0. && all > 0. ? std::max(1., near / n_near * n_all / all) : 1.;
}

}  // namespace

double FittedDecay::n_samples() const {
  double n = 0.;
  for (const std::vector<double>& error : errors) n += static_cast<double>(error.size());
  return n;
}

DecayLaw with_parameters(DecayLaw law, const LawParts& parts, const Eigen::VectorXd& x) {
  law.frequency_hz = std::exp(x[0]);
  law.damping_ratio = std::exp(x[1]);
  Eigen::Index i = 2;
  if (parts.cubic) law.cubic = x[i++];
  if (parts.drag) law.drag = std::exp(x[i++]);
  if (parts.friction) {
    law.slip = std::exp(x[i]);
    law.stick_ratio = std::exp(x[i + 1]);
  }
  return law;
}

FittedDecay fit_decay(const DecayLaw& law, const LawParts& parts, Spans pieces,
                      const double sampling_rate_hz) {
  const DecayProblem problem(law, parts, pieces, sampling_rate_hz);
  const Eigen::Index n_law = problem.n_law();
  Eigen::VectorXd start = Eigen::VectorXd::Zero(problem.first_of(pieces.size()));
  start.head(n_law) = parameters_of(law, parts);
  double n_samples = 0.;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const DecayStart first = first_state(law, pieces[p], sampling_rate_hz);
    const Eigen::Index at = problem.first_of(p);
    start.segment(at, 3) << first.moment, first.rate, first.offset;
    if (parts.friction) start[at + n_moments] = first.rate > 0. ? 1. : -1.;  // it slips that way
    n_samples += static_cast<double>(pieces[p].size());
  }
  if (NormalEquations equations; !problem.linearise(start, equations))
    return {.law = law, .parts = parts, .squares = std::numeric_limits<double>::infinity()};
  const LevenbergResult best = minimise(
      start, [&](const auto& x, auto& equations) { return problem.linearise(x, equations); },
      {.n_residuals = n_samples});
  FittedDecay out{.law = with_parameters(law, parts, best.parameters.head(n_law)),
                  .parts = parts,
                  .parameters = best.parameters.head(n_law),
                  .squares = best.equations.cost,
                  .n_unknowns = static_cast<std::size_t>(start.size())};
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    out.starts.push_back(problem.start_of(best.parameters, p));
    out.errors.push_back(problem.error(best.parameters, p));
  }
  const Eigen::MatrixXd inverse = inverse_information(best.equations.matrix);
  if (inverse.size() > 0)
    out.covariance = inverse.topLeftCorner(n_law, n_law) * out.squares /
                     (n_samples - static_cast<double>(start.size())) *
                     colour_at(out.errors, out.law.frequency_hz, sampling_rate_hz);
  return out;
}

}  // namespace vibrissa::separation
