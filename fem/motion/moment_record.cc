#include "fem/motion/moment_record.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::fem {

double largest_component(const std::array<double, 3>& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

void add_moment(const std::array<double, 3>& moment, const std::array<double, 3>& axial,
                MomentRecord& record) {
  // About e_z x axial, and about -axial (reduced_model.h).
  record.base_moment.push_back(-moment[0] * axial[1] + moment[1] * axial[0]);
  record.cross_moment.push_back(-(moment[0] * axial[0] + moment[1] * axial[1]));
}

void compare_routes(const std::array<double, 3>& moment, const std::array<double, 3>& other,
                    MomentRecord& record) {
  std::array<double, 3> between{};
  for (unsigned int d = 0; d < 3; ++d) between[d] = other[d] - moment[d];
  record.largest_difference = std::max(record.largest_difference, largest_component(between));
  record.largest_component = std::max(record.largest_component, largest_component(moment));
}

}  // namespace vibrissa::fem
