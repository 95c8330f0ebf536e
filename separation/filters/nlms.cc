#include "separation/filters/nlms.h"

#include <cassert>

namespace vibrissa::separation {

void Nlms::process(std::span<const double> base_acceleration, std::span<const double> base_moment,
                   std::span<double> wind_moment) {
  assert(base_acceleration.size() == wind_moment.size());
  assert(base_moment.size() == wind_moment.size());
  for (std::size_t i = 0; i < wind_moment.size(); ++i)
    wind_moment[i] = lms_.step(base_acceleration[i], base_moment[i]);
}

}  // namespace vibrissa::separation
