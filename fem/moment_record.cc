#include "fem/moment_record.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::fem {

double largest_component(const std::array<double, 3>& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

void MomentRecorder::add(const std::array<double, 3>& moment) {
  // About e_z x axial, and about -axial (reduced_model.h).
  record_.base_moment.push_back(-moment[0] * axial_[1] + moment[1] * axial_[0]);
  record_.cross_moment.push_back(-(moment[0] * axial_[0] + moment[1] * axial_[1]));
}

void MomentRecorder::compare(const std::array<double, 3>& moment,
                             const std::array<double, 3>& other) {
  std::array<double, 3> between{};
  for (unsigned int d = 0; d < 3; ++d) between[d] = other[d] - moment[d];
  difference_ = std::max(difference_, largest_component(between));
  peak_ = std::max(peak_, largest_component(moment));
  record_.largest_route_difference = peak_ > 0. ? difference_ / peak_ : 0.;
}

}  // namespace vibrissa::fem
