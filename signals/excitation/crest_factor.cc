#include "signals/excitation/crest_factor.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <set>
#include <string>

#include "signals/base/error.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

using Eigen::VectorXd;

void check_lines(const std::vector<std::size_t>& order, std::size_t n_amplitudes,
                 std::size_t n_phases) {
  if (order.empty() || n_amplitudes != order.size() || n_phases != order.size())
    throw UserError(
        "crest factor: " + std::to_string(order.size()) + " lines with " +
        std::to_string(n_amplitudes) + " amplitudes and " + std::to_string(n_phases) +
        " phases; at least one line is needed, and each line needs one amplitude and one phase");
  const std::set<std::size_t> distinct(order.begin(), order.end());
  if (distinct.count(0) != 0 || distinct.size() != order.size())
    throw UserError(
        "crest factor: a line has order 0 or is given twice; give each line once, with an order of "
        "at least 1");
}

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// The oversampled sum over one period, and its transforms.
class PeriodSum {
 public:
  PeriodSum(const std::vector<std::size_t>& order, const std::vector<double>& amplitude,
            std::size_t oversampling)
      : order_(order), amplitude_(vector_of(amplitude)), fft_(fft_length(order, oversampling)) {}

  double root_mean_square() const { return std::sqrt(0.5 * amplitude_.squaredNorm()); }
  std::span<double> time() { return fft_.time(); }

  void sum(const VectorXd& phase) {
    std::ranges::fill(fft_.spectrum(), 0.);
    for (Eigen::Index i = 0; i < phase.size(); ++i)
      fft_.spectrum()[order_of(i)] =
          std::polar(0.5 * amplitude_[i] * static_cast<double>(fft_.size()), phase[i]);
    fft_.inverse();
  }

  double peak() {
    double largest = 0.;
    for (const double x : fft_.time()) largest = std::max(largest, std::abs(x));
    return largest;
  }

  /// Phases of the lines of what time() holds now.
  void read_phases(VectorXd& phase) {
    fft_.forward();
    for (Eigen::Index i = 0; i < phase.size(); ++i)
      phase[i] = std::arg(fft_.spectrum()[order_of(i)]);
  }

  /// log of the p-norm of the sum, and its gradient by the phases.
  double log_norm(const VectorXd& phase, std::size_t p, VectorXd& gradient) {
    sum(phase);
    const double scale = peak();
    double total = 0.;
    for (double& x : fft_.time()) {
      const double weight = power(x / scale, p - 1);
      total += weight * x / scale;
      x = weight;
    }
    fft_.forward();
    for (Eigen::Index i = 0; i < phase.size(); ++i) {
      const auto turned = std::polar(1., phase[i]) * std::conj(fft_.spectrum()[order_of(i)]);
      gradient[i] = -amplitude_[i] * turned.imag() / (scale * total);
    }
    return std::log(scale) +
           std::log(total / static_cast<double>(fft_.size())) / static_cast<double>(p);
  }

 private:
  static std::size_t fft_length(const std::vector<std::size_t>& order, std::size_t oversampling) {
    std::size_t n = 16;
    while (n < 2 * oversampling * std::ranges::max(order)) n *= 2;
    return n;
  }

  // By squaring: std::pow takes most of the time otherwise.
  static double power(double x, std::size_t exponent) {
    double result = 1.;
    for (; exponent > 0; exponent /= 2, x *= x)
      if (exponent % 2 == 1) result *= x;
    return result;
  }

  std::size_t order_of(Eigen::Index i) const { return order_[static_cast<std::size_t>(i)]; }

  const std::vector<std::size_t>& order_;
  VectorXd amplitude_;
  RealFft fft_;
};

// Keeps the phases with the lowest peak so far.
struct Best {
  VectorXd phase;
  double peak;

  void see(const VectorXd& other, PeriodSum& sum) {
    sum.sum(other);
    const double other_peak = sum.peak();
    if (other_peak < peak) {
      phase = other;
      peak = other_peak;
    }
  }
};

// The clipping level rises slowly to the peak: hard clipping mixes the phases, gentle clipping
// refines them.
void clip(Best& best, PeriodSum& sum, std::size_t n_clippings) {
  VectorXd phase = best.phase;
  for (std::size_t i = 0; i < n_clippings; ++i) {
    best.see(phase, sum);
    const double progress = static_cast<double>(i) / static_cast<double>(n_clippings);
    const double level = (0.85 + 0.14 * progress) * sum.peak();
    for (double& x : sum.time()) x = std::clamp(x, -level, level);
    sum.read_phases(phase);
  }
}

// Limited-memory BFGS (Nocedal & Wright, Numerical Optimization, algorithm 7.4).
class Memory {
 public:
  VectorXd direction(const VectorXd& gradient) const {
    VectorXd d = -gradient;
    std::deque<double> share;
    for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {
      share.push_front(pair->step.dot(d) / pair->step.dot(pair->change));
      d -= share.front() * pair->change;
    }
    if (!pairs_.empty())
      d *= pairs_.back().step.dot(pairs_.back().change) / pairs_.back().change.squaredNorm();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double back = pairs_[i].change.dot(d) / pairs_[i].step.dot(pairs_[i].change);
      d += (share[i] - back) * pairs_[i].step;
    }
    return d;
  }

  void add(const VectorXd& step, const VectorXd& change) {
    if (!(step.dot(change) > 1e-12 * step.norm() * change.norm())) return;
    pairs_.push_back({step, change});
    if (pairs_.size() > n_pairs) pairs_.pop_front();
  }

 private:
  static constexpr std::size_t n_pairs = 12;
  struct Pair {
    VectorXd step, change;
  };
  std::deque<Pair> pairs_;
};

VectorXd descend(VectorXd phase, PeriodSum& sum, std::size_t exponent, std::size_t n_descents) {
  VectorXd gradient(phase.size()), next_gradient(phase.size());
  double value = sum.log_norm(phase, exponent, gradient);
  Memory memory;
  for (std::size_t i = 0; i < n_descents; ++i) {
    VectorXd direction = memory.direction(gradient);
    if (!(direction.dot(gradient) < 0.)) direction = -gradient;
    // No phase turns by more than half a radian at once: the norm is far from quadratic.
    double length = std::min(1., 0.5 / direction.cwiseAbs().maxCoeff());
    bool lower = false;
    for (int halving = 0; halving < 20 && !lower; ++halving, length *= 0.5) {
      const VectorXd next = phase + length * direction;
      const double next_value = sum.log_norm(next, exponent, next_gradient);
      if (!(next_value <= value + 1e-4 * length * direction.dot(gradient))) continue;
      memory.add(next - phase, next_gradient - gradient);
      phase = next;
      gradient = next_gradient;
      value = next_value;
      lower = true;
    }
    if (!lower) break;
  }
  return phase;
}

}  // namespace

double crest_factor_of_period(const std::vector<std::size_t>& order,
                              const std::vector<double>& amplitude,
                              const std::vector<double>& phase_rad) {
  check_lines(order, amplitude.size(), phase_rad.size());
  PeriodSum sum(order, amplitude, 16);
  sum.sum(vector_of(phase_rad));
  return sum.peak() / sum.root_mean_square();
}

std::vector<double> lower_crest_factor(const std::vector<std::size_t>& order,
                                       const std::vector<double>& amplitude,
                                       std::vector<double> phase_rad, const CrestOptions& options) {
  check_lines(order, amplitude.size(), phase_rad.size());
  PeriodSum sum(order, amplitude, 8);
  sum.sum(vector_of(phase_rad));
  Best best{vector_of(phase_rad), sum.peak()};
  if (order.size() < 2) return phase_rad;
  clip(best, sum, options.n_clippings);
  VectorXd phase = best.phase;
  for (std::size_t p = 4; p <= options.largest_exponent; p *= 2) {
    phase = descend(phase, sum, p, options.n_descents);
    best.see(phase, sum);
  }
  const std::vector<double> found(best.phase.begin(), best.phase.end());
  const bool better = crest_factor_of_period(order, amplitude, found) <
                      crest_factor_of_period(order, amplitude, phase_rad);
  return better ? found : phase_rad;
}

}  // namespace vibrissa::signals
