#include "separation/identification/channel_delay.h"

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "separation/identification/pole_search.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

namespace {

constexpr std::size_t most_modes = 3;

// A short window: the delay is told by the phase over the band, not by the width of a peak.
std::size_t window_of(std::size_t n_samples) {
  constexpr std::size_t shortest = 32, longest = 256;
  return std::clamp(std::bit_floor(n_samples / 8), shortest, longest);
}

struct ElasticFit {
  Bvrm model;  // b1 = 0
  double criterion = std::numeric_limits<double>::infinity();
};

/// The best gains of an elastic moment with these poles.
ElasticFit elastic_fit(const FrequencyProblem& problem, const std::vector<ModalTerm>& poles,
                       double highest_rad_s) {
  const auto n_modes = static_cast<Eigen::Index>(poles.size());
  const auto admissible = [&](const ModalTerm& mode) {
    return is_stable_below(mode, highest_rad_s);
  };
  if (!std::ranges::all_of(poles, admissible)) return {};
  Eigen::MatrixXd columns(problem.n_residuals(), n_modes + 1);
  for (Eigen::Index k = 0; k < n_modes; ++k) {
    const ModalTerm& mode = poles[static_cast<std::size_t>(k)];
    columns.col(k) = problem.gain_columns(mode.a1, mode.a0).col(1);
  }
  columns.col(n_modes) = problem.direct_column();
  const Eigen::VectorXd measured = problem.residual(Eigen::VectorXd::Zero(1));
  const Eigen::VectorXd length = columns.colwise().norm();
  columns.array().rowwise() /= length.transpose().array();
  const Eigen::VectorXd gain = columns.colPivHouseholderQr().solve(measured);
  const auto n = static_cast<double>(measured.size());
  const auto n_unknowns = static_cast<double>(3 * n_modes + 2);
  const double cost = (measured - columns * gain).squaredNorm();
  ElasticFit fit{.model = {.modes = poles, .delay_s = problem.delay_s()},
                 .criterion = n * std::log(cost / n) + n_unknowns * std::log(n)};
  for (Eigen::Index k = 0; k < n_modes; ++k)
    fit.model.modes[static_cast<std::size_t>(k)].b0 = gain[k] / length[k];
  fit.model.direct_term_kg_m = gain[n_modes] / length[n_modes];
  return fit;
}

/// The best one for each number of modes, from one on.
std::vector<ElasticFit> best_whole_delays(const signals::FrequencyResponse& response,
                                          double rate_hz, Hold hold, std::ptrdiff_t most_samples) {
  std::vector<ElasticFit> best(most_modes);
  for (std::ptrdiff_t samples = -most_samples; samples <= most_samples; ++samples) {
    const FrequencyProblem problem(response, std::nullopt, true,
                                   static_cast<double>(samples) / rate_hz);
    for (std::size_t n_modes = 1; n_modes <= most_modes; ++n_modes) {
      ElasticFit fit = elastic_fit(problem, vector_fitting_poles(problem, n_modes),
                                   highest_rad_s(hold, rate_hz));
      if (fit.criterion < best[n_modes - 1].criterion) best[n_modes - 1] = std::move(fit);
    }
  }
  return best;
}

/// Output error as a function of the delay, each fit started where the one before ended.
class Profile {
 public:
  Profile(Bvrm start, std::span<const Segment> segments, double rate_hz, OutputErrorOptions options)
      : model_(std::move(start)), segments_(segments), rate_hz_(rate_hz), options_(options) {
    options_.viscous_term = false;
    for (const Segment& segment : segments)
      n_samples_ += static_cast<double>(segment.base_moment.size());
  }

  /// Residual variance.
  double operator()(double delay_s) {
    model_.delay_s = delay_s;
    FittedBvrm fit = refine_output_error(model_, segments_, rate_hz_, options_);
    model_ = std::move(fit.model);
    return fit.residual_variance;
  }

  double n_samples() const { return n_samples_; }
  const Bvrm& model() const { return model_; }

 private:
  Bvrm model_;
  std::span<const Segment> segments_;
  double rate_hz_;
  OutputErrorOptions options_;
  double n_samples_ = 0.;
};

/// Minimum of a function within [low, high] by golden sections.
template <typename Function>
double minimum(Function& function, double low, double high) {
  constexpr double golden = 0.6180339887498949;
  constexpr int n_sections = 14;
  double left = high - golden * (high - low), right = low + golden * (high - low);
  double at_left = function(left), at_right = function(right);
  for (int i = 0; i < n_sections; ++i) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - golden * (high - low);
      at_left = function(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + golden * (high - low);
      at_right = function(right);
    }
  }
  return 0.5 * (low + high);
}

/// With n samples of variance v(d), the information about the delay d is n v'' / (2 v).
double deviation(Profile& profile, double delay_s, double step_s) {
  const double at = profile(delay_s);
  const double curvature =
      (profile(delay_s + step_s) - 2. * at + profile(delay_s - step_s)) / (step_s * step_s);
  return curvature > 0. ? std::sqrt(2. * at / (curvature * profile.n_samples()))
                        : std::numeric_limits<double>::infinity();
}

/// Of the frequency response; none where the record is too short.
std::vector<ElasticFit> rough_fits(std::span<const Segment> segments, double rate_hz,
                                   const OutputErrorOptions& fit) {
  const Segment& longest = *std::ranges::max_element(
      segments, {}, [](const Segment& segment) { return segment.base_moment.size(); });
  const std::size_t window = window_of(longest.base_moment.size());
  if (longest.base_moment.size() < 4 * window) return {};
  const auto response = signals::welch_response(longest.base_acceleration, longest.base_moment,
                                                rate_hz, {.segment_samples = window});
  return best_whole_delays(response, rate_hz, fit.hold, static_cast<std::ptrdiff_t>(window / 4));
}

struct Refined {
  ElasticDelay found;
  double criterion = 0.;  // of the samples, which have no leakage
};

Refined refine(const ElasticFit& rough, std::span<const Segment> segments, double rate_hz,
               const OutputErrorOptions& fit) {
  const double sample_s = 1. / rate_hz, from = rough.model.delay_s;
  Profile profile(rough.model, segments, rate_hz, fit);
  const double delay_s = minimum(profile, from - 1.5 * sample_s, from + 1.5 * sample_s);
  const double deviation_s = deviation(profile, delay_s, 0.1 * sample_s);
  const double n = profile.n_samples(), variance = profile(delay_s);
  const auto n_unknowns = static_cast<double>(3 * rough.model.modes.size() + 2);
  return {{{delay_s, deviation_s}, profile.model()},
          n * std::log(variance) + n_unknowns * std::log(n)};
}

}  // namespace

std::optional<ElasticDelay> elastic_delay(std::span<const Segment> segments,
                                          double sampling_rate_hz, const OutputErrorOptions& fit) {
  std::optional<ElasticDelay> best;
  double least = std::numeric_limits<double>::infinity();
  for (const ElasticFit& rough : rough_fits(segments, sampling_rate_hz, fit)) {
    if (!std::isfinite(rough.criterion)) continue;
    const Refined refined = refine(rough, segments, sampling_rate_hz, fit);
    if (!(refined.criterion < least)) continue;
    least = refined.criterion;
    best = refined.found;
  }
  return best;
}

std::optional<Estimate> estimate_delay(std::span<const Segment> segments, double sampling_rate_hz,
                                       const OutputErrorOptions& fit) {
  const std::vector<ElasticFit> rough = rough_fits(segments, sampling_rate_hz, fit);
  const auto best = std::ranges::min_element(rough, {}, &ElasticFit::criterion);
  if (best == rough.end() || !std::isfinite(best->criterion)) return std::nullopt;
  const Estimate found = refine(*best, segments, sampling_rate_hz, fit).found.delay_s;
  constexpr double significant = 4.;  // standard deviations
  constexpr double of_a_hold = 1.5;   // samples
  if (std::abs(found.value) < of_a_hold / sampling_rate_hz ||
      !(std::abs(found.value) > significant * found.standard_deviation))
    return std::nullopt;
  return found;
}

}  // namespace vibrissa::separation
