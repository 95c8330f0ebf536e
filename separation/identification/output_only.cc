#include "separation/identification/output_only.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;
using Pole = std::complex<double>;
using PolesByOrder = std::vector<std::vector<Pole>>;

constexpr std::size_t n_pieces = 20;

// Residual of a linear fit.
std::vector<double> without_line(std::span<const double> x) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const Eigen::ArrayXd time = Eigen::ArrayXd::LinSpaced(n, -1., 1.);
  const Eigen::Map<const Eigen::ArrayXd> given(x.data(), n);
  const double slope = (time * given).sum() / time.square().sum();
  const Eigen::ArrayXd left = given - given.mean() - slope * time;
  return {left.begin(), left.end()};
}

/// Sums of x[i] x[i + lag], i in one piece of the record, lag = 1, 2, ...: [lag - 1][piece].
struct LagSums {
  LagSums(std::span<const double> x, std::size_t n_lags)
      : sums(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(n_lags), n_pieces)),
        counts(Eigen::ArrayXXd::Zero(sums.rows(), n_pieces)) {
    for (std::size_t lag = 1; lag <= n_lags; ++lag)
      for (std::size_t i = 0; i + lag < x.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(lag - 1);
        const auto piece = static_cast<Eigen::Index>(i * n_pieces / x.size());
        sums(row, piece) += x[i] * x[i + lag];
        counts(row, piece) += 1.;
      }
  }

  /// Of the whole record, or without one piece.
  std::vector<double> covariances(std::optional<std::size_t> without = std::nullopt) const {
    Eigen::ArrayXd sum = sums.rowwise().sum(), count = counts.rowwise().sum();
    if (without) {
      sum -= sums.col(static_cast<Eigen::Index>(*without));
      count -= counts.col(static_cast<Eigen::Index>(*without));
    }
    const Eigen::ArrayXd mean = sum / count;
    return {mean.begin(), mean.end()};
  }

  Eigen::ArrayXXd sums, counts;
};

// Eigenvectors of a symmetric matrix by falling size of their eigenvalues.
Eigen::MatrixXd leading_vectors(const Eigen::MatrixXd& matrix, Eigen::Index n) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(matrix.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, std::greater<>(),
                    [&](Eigen::Index i) { return std::abs(solver.eigenvalues()[i]); });
  Eigen::MatrixXd vectors(matrix.rows(), n);
  for (Eigen::Index j = 0; j < n; ++j)
    vectors.col(j) = solver.eigenvectors().col(order[static_cast<std::size_t>(j)]);
  return vectors;
}

std::vector<Pole> continuous_poles(const Eigen::MatrixXd& transition, double sampling_rate_hz) {
  std::vector<Pole> poles;
  const Eigen::VectorXcd sampled = transition.eigenvalues();
  for (const Pole& z : sampled)
    if (z.imag() > 0.) poles.push_back(std::log(z) * sampling_rate_hz);
  return poles;
}

double decay_per_s(const Pole& pole) {
  return std::max(0., -pole.real());
}

// How far a pole may move and still be the same: half its half width, or of an undamped one a
// thousandth of its frequency.
double reach(const Pole& pole) {
  return 0.5 * decay_per_s(pole) + 1e-3 * std::abs(pole);
}

const Pole* nearest(const std::vector<Pole>& poles, const Pole& to) {
  const auto found =
      std::ranges::min_element(poles, {}, [&](const Pole& p) { return std::abs(p - to); });
  return found == poles.end() ? nullptr : &*found;
}

/// One pole followed through rising orders.
struct Chain {
  std::size_t first_order = 0;  // place in PolesByOrder
  std::vector<Pole> poles;      // of successive orders
  std::size_t end() const { return first_order + poles.size(); }
};

std::vector<Chain> chains_of(const PolesByOrder& by_order) {
  std::vector<Chain> chains;
  for (std::size_t k = 0; k < by_order.size(); ++k)
    for (const Pole& pole : by_order[k]) {
      const auto goes_on = [&](const Chain& chain) {
        return chain.end() == k && std::abs(pole - chain.poles.back()) < reach(pole);
      };
      const auto found = std::ranges::find_if(chains, goes_on);
      if (found != chains.end())
        found->poles.push_back(pole);
      else
        chains.push_back({k, {pole}});
    }
  return chains;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// Medians of both parts over the orders.
Pole centre(const std::vector<Pole>& poles) {
  std::vector<double> real, imaginary;
  for (const Pole& pole : poles) {
    real.push_back(pole.real());
    imaginary.push_back(pole.imag());
  }
  return {median(real), median(imaginary)};
}

// The chains over at least a third of the orders; the longest of several near the same pole.
std::vector<Chain> standing_chains(const PolesByOrder& by_order) {
  const std::size_t fewest = std::max<std::size_t>(3, by_order.size() / 3);
  std::vector<Chain> chains = chains_of(by_order), long_chains;
  std::ranges::stable_sort(chains, std::greater<>(),
                           [](const Chain& chain) { return chain.poles.size(); });
  for (const Chain& chain : chains) {
    const auto same = [&](const Chain& other) {
      const Pole pole = centre(other.poles);
      return std::abs(centre(chain.poles) - pole) < std::abs(decay_per_s(pole)) + reach(pole);
    };
    if (chain.poles.size() >= fewest && std::ranges::none_of(long_chains, same))
      long_chains.push_back(chain);
  }
  return long_chains;
}

// The same orders' poles of another set of covariances, next to these.
Pole centre_beside(const Chain& chain, const PolesByOrder& by_order) {
  std::vector<Pole> poles;
  for (std::size_t i = 0; i < chain.poles.size(); ++i) {
    const Pole* beside = nearest(by_order[chain.first_order + i], chain.poles[i]);
    poles.push_back(beside ? *beside : Pole{});
  }
  return centre(poles);
}

double frequency_hz(const Pole& pole) {
  return std::abs(pole) / (2. * std::numbers::pi);
}

double damping_ratio(const Pole& pole) {
  return -pole.real() / std::abs(pole);
}

// Deviation of an estimate from what it becomes without each piece in turn.
double jackknife(const std::vector<double>& without) {
  const double n = static_cast<double>(without.size());
  const double mean = std::accumulate(without.begin(), without.end(), 0.) / n;
  double sum = 0.;
  for (const double value : without) sum += (value - mean) * (value - mean);
  return std::sqrt((n - 1.) / n * sum);
}

OutputOnlyMode mode_of(const Chain& chain, const std::vector<PolesByOrder>& without_piece) {
  const Pole pole = centre(chain.poles);
  std::vector<double> frequencies, dampings;
  for (const PolesByOrder& by_order : without_piece) {
    const Pole beside = centre_beside(chain, by_order);
    frequencies.push_back(frequency_hz(beside));
    dampings.push_back(damping_ratio(beside));
  }
  return {.frequency_hz = {frequency_hz(pole), jackknife(frequencies)},
          .damping_ratio = {damping_ratio(pole), jackknife(dampings)},
          .n_orders = chain.poles.size()};
}

bool is_determined(const OutputOnlyMode& mode, double longest_lag_s) {
  const double zeta = mode.damping_ratio.value;
  return mode.frequency_hz.value * longest_lag_s >= 1. &&
         mode.damping_ratio.standard_deviation < 0.5 * zeta &&
         mode.frequency_hz.standard_deviation < 0.5 * zeta * mode.frequency_hz.value;
}

// The frequency is known to a fraction of the resolution of the lags; the decay is not
// significantly different from zero.
bool is_undamped(const OutputOnlyMode& mode, double longest_lag_s) {
  return mode.frequency_hz.value * longest_lag_s >= 1. &&
         mode.damping_ratio.value < 2. * mode.damping_ratio.standard_deviation + 1e-4 &&
         mode.frequency_hz.standard_deviation * longest_lag_s < 0.1;
}

std::string describe(const OutputOnlyIdentification& found) {
  std::string words = found.modes.empty() ? "no resonance was found" : "";
  if (!found.undamped_hz.empty())
    words += std::string(words.empty() ? "" : "; ") +
             "an undamped line is a line of the excitation, or a mode whose damping the record "
             "does not determine";
  return words + (words.empty() ? "" : "; ") +
         "identification from the output alone gives no gain and no direct term; it assumes white "
         "excitation, so a resonance of the excitation looks like a resonance of the sensor";
}

struct Sizes {
  std::size_t n_rows, max_order;
};

// The longest lag must stay well within one of the pieces that the jackknife leaves out.
Sizes checked_sizes(std::span<const double> moment, const OutputOnlyOptions& options) {
  constexpr std::size_t fewest_samples = 400;
  if (moment.size() < fewest_samples)
    throw UserError("output-only identification: " + std::to_string(moment.size()) +
                    " samples are too few; take at least " + std::to_string(fewest_samples));
  if (options.max_order < 2 || options.max_order % 2 != 0)
    throw UserError("output-only identification: order = " + std::to_string(options.max_order) +
                    " must be an even number of poles, at least 2 (two for each mode)");
  for (std::size_t i = 0; i < moment.size(); ++i)
    if (!std::isfinite(moment[i]))
      throw UserError("output-only identification: sample " + std::to_string(i) +
                      " of the moment is not finite");
  if (signals::is_constant(moment))
    throw UserError(
        "output-only identification: the moment is constant, so no mode can be identified from it");
  const std::size_t n_rows = std::min(options.max_lags, moment.size() / (4 * n_pieces));
  if (n_rows < 4)
    throw UserError("output-only identification: " + std::to_string(n_rows) +
                    " lags are too few; take at least 4");
  return {n_rows, std::min(options.max_order, (n_rows - 1) / 2 * 2)};
}

}  // namespace

PolesByOrder covariance_poles(std::span<const double> covariances, std::size_t max_order,
                              double sampling_rate_hz) {
  const auto n = static_cast<Eigen::Index>((covariances.size() + 1) / 2);
  const auto highest = static_cast<Eigen::Index>(max_order);
  Eigen::MatrixXd hankel(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      hankel(i, j) = covariances[static_cast<std::size_t>(i + j)];
  const Eigen::MatrixXd vectors = leading_vectors(hankel, highest);
  PolesByOrder by_order;
  for (Eigen::Index order = 2; order <= highest; order += 2) {
    const auto upper = vectors.topLeftCorner(n - 1, order);
    const auto lower = vectors.bottomLeftCorner(n - 1, order);
    by_order.push_back(continuous_poles(upper.householderQr().solve(lower), sampling_rate_hz));
  }
  return by_order;
}

OutputOnlyIdentification identify_output_only(std::span<const double> moment,
                                              double sampling_rate_hz,
                                              const OutputOnlyOptions& options) {
  const auto [n_rows, max_order] = checked_sizes(moment, options);
  const LagSums sums(without_line(moment), 2 * n_rows - 1);
  const auto poles = [&, max_order = max_order](std::optional<std::size_t> without) {
    return covariance_poles(sums.covariances(without), max_order, sampling_rate_hz);
  };
  std::vector<PolesByOrder> without_piece;
  for (std::size_t piece = 0; piece < n_pieces; ++piece) without_piece.push_back(poles(piece));

  OutputOnlyIdentification found;
  found.n_orders = max_order / 2;
  const double longest_lag_s = 2. * static_cast<double>(n_rows) / sampling_rate_hz;
  for (const Chain& chain : standing_chains(poles(std::nullopt))) {
    const OutputOnlyMode mode = mode_of(chain, without_piece);
    if (is_determined(mode, longest_lag_s))
      found.modes.push_back(mode);
    else if (is_undamped(mode, longest_lag_s))
      found.undamped_hz.push_back(mode.frequency_hz);
  }
  std::ranges::sort(found.modes, {}, [](const auto& mode) { return mode.frequency_hz.value; });
  std::ranges::sort(found.undamped_hz, {}, &Estimate::value);
  found.words = describe(found);
  return found;
}

}  // namespace vibrissa::separation
