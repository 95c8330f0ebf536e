#include "signals/spectra/best_linear_approximation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals {

namespace {

void check_realisations(std::span<const PeriodAverage> realisations) {
  if (realisations.size() < 2)
    throw UserError("robust method: at least two realisations are needed, got " +
                    std::to_string(realisations.size()) +
                    "; measure more, or use the fast method on a random-odd grid");
  const PeriodAverage& first = realisations.front();
  for (const PeriodAverage& other : realisations)
    if (other.period_samples != first.period_samples ||
        other.sampling_rate_hz != first.sampling_rate_hz)
      throw UserError("robust method: realisations have periods of " +
                      std::to_string(first.period_samples) + " and " +
                      std::to_string(other.period_samples) +
                      " samples, or different sampling rates; all realisations need the same");
}

std::vector<std::size_t> common_lines(std::span<const PeriodAverage> realisations) {
  std::vector<std::size_t> lines = excited_orders(realisations.front());
  for (const PeriodAverage& other : realisations.subspan(1)) {
    std::vector<std::size_t> common;
    std::ranges::set_intersection(lines, excited_orders(other), std::back_inserter(common));
    lines = common;
  }
  if (lines.empty()) throw UserError("robust method: no line is excited in every realisation");
  return lines;
}

void check_lines(const PeriodAverage& average, const std::vector<std::size_t>& lines) {
  for (const std::size_t k : lines) {
    if (k < 1 || k > average.n_lines())
      throw UserError("best linear approximation: line " + std::to_string(k) +
                      " is not one of the lines 1 .. " + std::to_string(average.n_lines()));
    if (!(std::norm(average.input[k - 1]) > 0.))
      throw UserError("best linear approximation: the input is zero at line " + std::to_string(k) +
                      " (" + to_text(average.frequency_hz(k)) + " Hz)");
  }
}

void add_point(RobustApproximation& result, std::span<const PeriodAverage> realisations,
               std::size_t line) {
  const auto n = static_cast<double>(realisations.size());
  std::complex<double> mean = 0.;
  double noise = 0., scatter = 0.;
  for (const PeriodAverage& one : realisations) {
    mean += one.response(line) / n;
    noise += one.response_variance(line) / (n * n);
  }
  for (const PeriodAverage& one : realisations) scatter += std::norm(one.response(line) - mean);
  const double total = scatter / (n * (n - 1.));
  result.response.frequency_hz.push_back(realisations.front().frequency_hz(line));
  result.response.value.push_back(mean);
  result.response.standard_deviation.push_back(std::sqrt(total));
  result.response.coherence.push_back(std::norm(mean) / (std::norm(mean) + n * total));
  result.noise_variance.push_back(noise);
  result.distortion_variance.push_back(n * (total - noise));
}

// Lines between the first and last excited one that are not excited themselves.
std::vector<DetectedOutput> detection_lines(const PeriodAverage& average,
                                            const std::vector<std::size_t>& excited) {
  std::vector<DetectedOutput> found;
  for (std::size_t k = excited.front(); k <= excited.back(); ++k) {
    const auto next = std::ranges::lower_bound(excited, k);
    if (*next == k) continue;
    // The share of the input is computed with the mean response at the excited neighbours.
    const std::size_t below = *(next - 1), above = *next;
    const double share = static_cast<double>(k - below) / static_cast<double>(above - below);
    const auto response = (1. - share) * average.response(below) + share * average.response(above);
    const auto rest = average.output[k - 1] - response * average.input[k - 1];
    found.push_back({k, average.frequency_hz(k),
                     k % 2 == 0 ? LineRole::even_detection : LineRole::odd_detection,
                     std::norm(rest), average.residual_variance(k, response)});
  }
  return found;
}

std::vector<DetectedOutput> of_role(const std::vector<DetectedOutput>& all, LineRole role) {
  std::vector<DetectedOutput> chosen;
  std::ranges::copy_if(all, std::back_inserter(chosen),
                       [&](const DetectedOutput& line) { return line.role == role; });
  return chosen;
}

struct Level {
  double power = 0., distortion = 0.;
};

// Mean of the n lines nearest to an order; of equally near ones the lower counts first.
Level level_about(const std::vector<DetectedOutput>& lines, std::size_t order, std::size_t n) {
  const auto distance = [&](const DetectedOutput& line) {
    return line.order < order ? order - line.order : line.order - order;
  };
  auto first = lines.begin(), last = lines.end();
  while (static_cast<std::size_t>(last - first) > n) {
    if (distance(*first) > distance(*(last - 1)))
      ++first;
    else
      --last;
  }
  Level level;
  for (auto line = first; line != last; ++line) {
    level.power += line->power / static_cast<double>(n);
    level.distortion += (line->power - line->noise_power) / static_cast<double>(n);
  }
  return level;
}

std::vector<std::size_t> checked_excited(const PeriodAverage& average, const FastOptions& options) {
  auto excited = options.excited.empty() ? excited_orders(average, options.excitation_threshold)
                                         : options.excited;
  std::ranges::sort(excited);
  check_lines(average, excited);
  if (average.n_periods < 2)
    throw UserError(
        "fast method: at least two periods are needed to separate noise from distortion, got 1");
  for (const std::size_t k : excited)
    if (k % 2 == 0)
      throw UserError("fast method: even line " + std::to_string(k) +
                      " is excited, but the method needs a random-odd grid (use the robust method "
                      "for a full grid). If only noise makes this line look excited, average more "
                      "periods or raise the excitation level");
  return excited;
}

void check_count(const std::vector<DetectedOutput>& lines, std::size_t n_averaged,
                 const std::string& role) {
  if (n_averaged == 0 || lines.size() < n_averaged)
    throw UserError("fast method: " + std::to_string(lines.size()) + " " + role +
                    " detection lines are available, but " + std::to_string(n_averaged) +
                    " are to be averaged; average fewer (at least 1) or take a longer period");
}

}  // namespace

RobustApproximation robust_approximation(std::span<const PeriodAverage> realisations,
                                         std::vector<std::size_t> lines) {
  check_realisations(realisations);
  if (lines.empty()) lines = common_lines(realisations);
  for (const PeriodAverage& one : realisations) check_lines(one, lines);
  RobustApproximation result;
  result.n_realisations = realisations.size();
  result.n_periods = realisations.front().n_periods;
  for (const std::size_t line : lines) add_point(result, realisations, line);
  return result;
}

FastApproximation fast_approximation(const PeriodAverage& average, const FastOptions& options) {
  const auto excited = checked_excited(average, options);
  FastApproximation result;
  result.detection = detection_lines(average, excited);
  const auto even = of_role(result.detection, LineRole::even_detection);
  const auto odd = of_role(result.detection, LineRole::odd_detection);
  check_count(even, options.n_averaged, "even");
  if (!odd.empty()) check_count(odd, options.n_averaged, "odd");
  for (const std::size_t k : excited) {
    const auto response = average.response(k);
    const double input_power = std::norm(average.input[k - 1]);
    const double noise = average.residual_variance(k, response);
    result.noise_power.push_back(noise);
    result.even_power.push_back(level_about(even, k, options.n_averaged).distortion);
    // The whole power of the odd detection lines is noise and distortion without bias; noise plus
    // a distortion that must not be negative would be too much.
    double error_power = noise;
    if (!odd.empty()) {
      const Level level = level_about(odd, k, options.n_averaged);
      result.odd_power.push_back(level.distortion);
      error_power = level.power;
    }
    const double variance = error_power / input_power;
    result.noise_variance.push_back(noise / input_power);
    result.response.frequency_hz.push_back(average.frequency_hz(k));
    result.response.value.push_back(response);
    result.response.standard_deviation.push_back(std::sqrt(variance));
    result.response.coherence.push_back(std::norm(response) / (std::norm(response) + variance));
  }
  return result;
}

}  // namespace vibrissa::signals
