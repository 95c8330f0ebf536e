#include "separation/identification/output_only.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/median.h"
#include "signals/base/number_text.h"
#include "signals/spectra/resample.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;
using Pole = std::complex<double>;
using PolesByOrder = std::vector<std::vector<Pole>>;

constexpr std::size_t n_pieces = 20, fewest_orders = 3;

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

// Medians of both parts over the orders.
Pole centre(const std::vector<Pole>& poles) {
  std::vector<double> real, imaginary;
  for (const Pole& pole : poles) {
    real.push_back(pole.real());
    imaginary.push_back(pole.imag());
  }
  return {signals::median(std::move(real)), signals::median(std::move(imaginary))};
}

// The chains over at least a third of the orders; the longest of several near the same pole.
std::vector<Chain> standing_chains(const PolesByOrder& by_order) {
  const std::size_t fewest = std::max(fewest_orders, by_order.size() / 3);
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

void check_moment(std::span<const double> moment, const OutputOnlyOptions& options) {
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
}

/// Resonances and lines of one sampling rate.
struct OneRate {
  std::vector<OutputOnlyMode> modes;
  std::vector<Estimate> undamped_hz;
  std::size_t n_orders = 0;
  double rate_hz = 0., longest_lag_s = 0.;
};

OneRate at_one_rate(std::span<const double> moment, double rate_hz, std::size_t n_rows,
                    std::size_t max_order) {
  const LagSums sums(without_line(moment), 2 * n_rows - 1);
  // Whether a pole stands is seen over three orders at least, of which the last ones may be above
  // the highest order that gives modes.
  const std::size_t highest =
      std::min(std::max(max_order, 2 * fewest_orders), (n_rows - 1) / 2 * 2);
  const auto poles = [&](std::optional<std::size_t> without) {
    return covariance_poles(sums.covariances(without), highest, rate_hz);
  };
  std::vector<PolesByOrder> without_piece;
  for (std::size_t piece = 0; piece < n_pieces; ++piece) without_piece.push_back(poles(piece));
  OneRate found{.modes = {},
                .undamped_hz = {},
                .n_orders = highest / 2,
                .rate_hz = rate_hz,
                .longest_lag_s = 2. * static_cast<double>(n_rows) / rate_hz};
  for (const Chain& chain : standing_chains(poles(std::nullopt))) {
    if (2 * (chain.first_order + 1) > max_order) continue;
    const OutputOnlyMode mode = mode_of(chain, without_piece);
    if (is_determined(mode, found.longest_lag_s))
      found.modes.push_back(mode);
    else if (is_undamped(mode, found.longest_lag_s))
      found.undamped_hz.push_back(mode.frequency_hz);
  }
  return found;
}

// The longest lag must stay well within one of the pieces that the jackknife leaves out.
std::size_t most_rows(std::size_t n_samples) {
  return n_samples / (4 * n_pieces);
}

OneRate at_given_lags(std::span<const double> moment, double rate_hz,
                      const OutputOnlyOptions& options) {
  const std::size_t n_rows = std::min(*options.max_lags, most_rows(moment.size()));
  if (n_rows < 4)
    throw UserError("output-only identification: " + std::to_string(n_rows) +
                    " lags are too few; take at least 4");
  return at_one_rate(moment, rate_hz, n_rows, options.max_order);
}

/// The full rate first, then each half of the one before.
std::vector<OneRate> at_falling_rates(std::span<const double> moment, double rate_hz,
                                      std::size_t max_order) {
  constexpr std::size_t rows = 40, fewest_rows = 20;
  std::vector<OneRate> rates{
      at_one_rate(moment, rate_hz, std::min(rows, most_rows(moment.size())), max_order)};
  std::vector<double> slower(moment.begin(), moment.end());
  while (most_rows(slower.size() / 2) >= fewest_rows) {
    slower = signals::resample(without_line(slower), 2., 1.);
    const double slower_hz = rates.back().rate_hz / 2.;
    rates.push_back(
        at_one_rate(slower, slower_hz, std::min(rows, most_rows(slower.size())), max_order));
  }
  return rates;
}

bool is_same(const Estimate& a_hz, const Estimate& b_hz, double half_width_hz) {
  return std::abs(a_hz.value - b_hz.value) <
         half_width_hz + 4. * (a_hz.standard_deviation + b_hz.standard_deviation);
}

double half_width_hz(const OutputOnlyMode& mode) {
  return mode.damping_ratio.value * mode.frequency_hz.value;
}

/// Whether a mode decays by a factor e within these lags.
bool decays_within(const OutputOnlyMode& mode, double lag_s) {
  return 2. * std::numbers::pi * half_width_hz(mode) * lag_s > 1.;
}

/// Adds a mode; of the same mode found twice, the one whose damping is better determined.
void add(const OutputOnlyMode& mode, std::vector<OutputOnlyMode>& modes) {
  const auto other = std::ranges::find_if(modes, [&](const OutputOnlyMode& present) {
    return is_same(present.frequency_hz, mode.frequency_hz, half_width_hz(present));
  });
  if (other == modes.end())
    modes.push_back(mode);
  else if (mode.damping_ratio.standard_deviation < other->damping_ratio.standard_deviation)
    *other = mode;
}

/// Each resonance from the rate whose lags span 8 to 16 of its periods; a slow decay also from half
/// of that rate.
void join(const std::vector<OneRate>& rates, OutputOnlyIdentification& found) {
  constexpr double lowest_share = 0.1, overlap = 0.95;  // of the rate, of the lowest share
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const bool is_lowest = i + 1 == rates.size();
    const double from_hz = is_lowest ? 0. : overlap * lowest_share * rates[i].rate_hz;
    const double below_hz = i == 0 ? rates[0].rate_hz : 2. * lowest_share * rates[i].rate_hz;
    const auto is_here = [&](const Estimate& f) {
      return f.value >= from_hz && f.value < below_hz;
    };
    for (const OutputOnlyMode& mode : rates[i].modes)
      if (is_here(mode.frequency_hz)) add(mode, found.modes);
    for (const Estimate& line : rates[i].undamped_hz)
      if (is_here(line)) found.undamped_hz.push_back(line);
    if (is_lowest) break;
    for (const OutputOnlyMode& mode : rates[i + 1].modes)
      if (is_here(mode.frequency_hz) && !decays_within(mode, rates[i].longest_lag_s))
        add(mode, found.modes);
  }
  // A line near the border of two rates is found twice; longer lags may tell the decay of a line.
  std::vector<Estimate> lines;
  for (const Estimate& line : found.undamped_hz) {
    const auto is_mode = [&](const OutputOnlyMode& mode) {
      return is_same(mode.frequency_hz, line, half_width_hz(mode));
    };
    const auto is_line = [&](const Estimate& other) { return is_same(other, line, 0.); };
    if (std::ranges::none_of(found.modes, is_mode) && std::ranges::none_of(lines, is_line))
      lines.push_back(line);
  }
  found.undamped_hz = std::move(lines);
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
  check_moment(moment, options);
  OutputOnlyIdentification found;
  if (options.max_lags) {
    OneRate only = at_given_lags(moment, sampling_rate_hz, options);
    found.n_orders = only.n_orders;
    found.modes = std::move(only.modes);
    found.undamped_hz = std::move(only.undamped_hz);
  } else {
    const std::vector<OneRate> rates =
        at_falling_rates(moment, sampling_rate_hz, options.max_order);
    found.n_orders = rates.front().n_orders;
    join(rates, found);
  }
  std::ranges::sort(found.modes, {}, [](const auto& mode) { return mode.frequency_hz.value; });
  std::ranges::sort(found.undamped_hz, {}, &Estimate::value);
  found.words = describe(found);
  return found;
}

}  // namespace vibrissa::separation
