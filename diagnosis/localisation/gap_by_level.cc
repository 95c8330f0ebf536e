#include "diagnosis/localisation/gap_by_level.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

/// Relative gap at the excited lines of one record, minus noise, and the level of its motion.
struct LevelPoint {
  double log_level = 0., log_gap = 0., variance = 0.;
};

std::optional<LevelPoint> level_point(const RecordGap& gap) {
  const PreparedRecord& record = *gap.record;
  double level = 0., error = 0., noise = 0., noise_square = 0., measured = 0.;
  for (std::size_t b = 0; b < gap.error.size(); ++b) {
    const double a = std::norm(record.acceleration[record.whole_line(b)]);
    if (a == 0.) continue;
    level += a;
    error += std::norm(gap.error[b]);
    noise += gap.variance[b];
    noise_square += gap.variance[b] * (gap.variance[b] + 2. * std::norm(gap.error[b]));
    measured += std::norm(record.moment[b]);
  }
  const double square = error - noise;
  if (!(square > 3. * std::sqrt(noise_square)) || level == 0.) return std::nullopt;
  return LevelPoint{0.5 * std::log(level) - std::log(static_cast<double>(record.n_samples)),
                    0.5 * std::log(square / measured), 0.25 * noise_square / (square * square)};
}

}  // namespace

std::optional<LevelExponent> level_exponent(const std::vector<RecordGap>& gaps) {
  std::vector<LevelPoint> points;
  for (const RecordGap& gap : gaps)
    if (kind_of(*gap.record) == "base" && gap.record->periodic)
      if (const auto point = level_point(gap)) points.push_back(*point);
  if (points.size() < 2) return std::nullopt;
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(),
                          [](const auto& a, const auto& b) { return a.log_level < b.log_level; });
  constexpr double least_ratio = 1.3;
  if (high->log_level - low->log_level < std::log(least_ratio)) return std::nullopt;
  // Scatter of the relative gap in addition to noise, because lines and phases differ between
  // records.
  constexpr double scatter = 0.05;
  double w = 0., wx = 0., wy = 0., wxx = 0., wxy = 0.;
  for (const LevelPoint& p : points) {
    const double weight = 1. / (p.variance + scatter * scatter);
    w += weight;
    wx += weight * p.log_level;
    wy += weight * p.log_gap;
    wxx += weight * p.log_level * p.log_level;
    wxy += weight * p.log_level * p.log_gap;
  }
  const double spread = wxx - wx * wx / w;
  const double slope = (wxy - wx * wy / w) / spread;
  const double deviation = 1. / std::sqrt(spread);
  return LevelExponent{std::abs(slope) > 2. * deviation ? slope : 0., deviation};
}

}  // namespace vibrissa::diagnosis
