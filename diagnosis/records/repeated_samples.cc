#include "diagnosis/records/repeated_samples.h"

#include <cmath>
#include <set>

#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

/// Indices where runs of equal samples begin.
std::vector<std::size_t> run_starts(const std::span<const double> x) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (i == 0 || x[i] != x[i - 1]) out.push_back(i);
  return out;
}

struct Line {
  double intercept = 0., slope = 1.;
};

/// Least-squares line of the indices over their numbers.
Line line_through(const std::vector<std::size_t>& indices) {
  const double n = static_cast<double>(indices.size()), middle = 0.5 * (n - 1.);
  double sum = 0., moment = 0., square = 0.;
  for (std::size_t j = 0; j < indices.size(); ++j) {
    const double d = static_cast<double>(j) - middle;
    sum += static_cast<double>(indices[j]);
    moment += d * static_cast<double>(indices[j]);
    square += d * d;
  }
  const double slope = square > 0. ? moment / square : 1.;
  return {sum / n - slope * middle, slope};
}

}  // namespace

double repeat_share(const std::span<const double> x) {
  if (x.empty()) return 0.;
  return 1. - static_cast<double>(run_starts(x).size()) / static_cast<double>(x.size());
}

bool is_held(const std::span<const double> x) {
  constexpr double many = 0.08;
  return repeat_share(x) > many && std::set<double>(x.begin(), x.end()).size() > x.size() / 4;
}

std::vector<double> new_sample_series(const std::span<const double> x) {
  std::vector<std::size_t> indices = run_starts(x);
  if (indices.size() % 2 != 0) indices.pop_back();
  if (indices.empty()) return {x.begin(), x.end()};
  std::vector<double> source;
  for (const std::size_t index : indices) source.push_back(x[index]);
  const Line line = line_through(indices);
  return resampled(spectrum_of(source), source.size(), x.size(), -line.intercept / line.slope,
                   1. / line.slope);
}

double unknown_age(const std::span<const double> x) {
  constexpr int longest = 16;
  const double period = line_through(run_starts(x)).slope;
  for (int q = 1; q <= longest; ++q) {
    const double n_source_samples = q / period;
    // The position in the period drifts by less than a step over the whole record.
    if (std::abs(n_source_samples - std::round(n_source_samples)) * static_cast<double>(x.size()) <
        1.)
      return period / q;
  }
  return 0.;
}

}  // namespace vibrissa::diagnosis
