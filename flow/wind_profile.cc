#include "flow/wind_profile.h"

#include <algorithm>
#include <cassert>

namespace vibrissa::flow {

double profile_factor(const WindProfile profile, const double z, const double height) {
  assert(height > 0.);
  if (profile == WindProfile::uniform) return 1.;
  const double s = std::clamp(z / height, 0., 1.);
  return s * (2. - s);
}

}  // namespace vibrissa::flow
