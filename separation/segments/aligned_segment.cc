#include "separation/segments/aligned_segment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "separation/model/input_shaper.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_values(std::span<const double> x, std::size_t segment, const std::string& name,
                  const std::string& who) {
  const auto bad = std::ranges::find_if_not(x, [](double value) { return std::isfinite(value); });
  if (bad != x.end())
    throw UserError(who + ": segment " + std::to_string(segment + 1) + ", sample " +
                    std::to_string(bad - x.begin()) + " of the " + name + " is not finite");
}

AlignedSegment align(const Segment& segment, const SampledDelay& delay, Hold hold) {
  const auto n = static_cast<std::ptrdiff_t>(segment.base_moment.size());
  const std::ptrdiff_t length =
      std::max<std::ptrdiff_t>(0, n - std::max<std::ptrdiff_t>(0, delay.shift));
  const bool between = lies_between(delay, hold);
  ShapedInput shaped = shape_input(segment.base_acceleration, hold, delay.fraction);
  AlignedSegment aligned{.node = std::move(shaped.node),
                         .midpoint = std::move(shaped.midpoint),
                         .direct = std::move(shaped.direct),
                         .output = std::vector<double>(static_cast<std::size_t>(length), 0.)};
  if (between) {
    const double older = hold == Hold::zero_order ? 1. : delay.fraction;
    for (std::size_t i = 1; i < aligned.direct.size(); ++i)
      aligned.direct[i] = (1. - older) * aligned.node[i] + older * aligned.node[i - 1];
  }
  const std::ptrdiff_t first =
      std::min(std::max<std::ptrdiff_t>(between ? 1 : 0, -delay.shift), length);
  aligned.first = static_cast<std::size_t>(first);
  if (first < length)
    std::copy_n(segment.base_moment.begin() + (first + delay.shift), length - first,
                aligned.output.begin() + first);
  return aligned;
}

}  // namespace

bool lies_between(const SampledDelay& delay, Hold hold) {
  return delay.fraction > 0. && hold != Hold::band_limited;
}

std::vector<AlignedSegment> align_segments(std::span<const Segment> segments,
                                           const SampledDelay& delay, Hold hold,
                                           const std::string& who) {
  std::vector<AlignedSegment> aligned;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    check_values(segments[i].base_acceleration, i, "base acceleration", who);
    check_values(segments[i].base_moment, i, "base moment", who);
    if (segments[i].base_acceleration.size() != segments[i].base_moment.size())
      throw UserError(who + ": segment " + std::to_string(i + 1) + " has " +
                      std::to_string(segments[i].base_acceleration.size()) +
                      " samples of base acceleration, but " +
                      std::to_string(segments[i].base_moment.size()) + " of base moment");
    aligned.push_back(align(segments[i], delay, hold));
  }
  return aligned;
}

}  // namespace vibrissa::separation
