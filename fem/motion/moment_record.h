#pragma once

#include <array>
#include <vector>

namespace vibrissa::fem {

/// Base moment of a transient at every sample.
struct MomentRecord {
  std::vector<double> base_moment, cross_moment;  // from the reactions of the clamp [N m]
  double largest_component = 0.;                  // of the compared moments [N m]
  double largest_difference = 0.;                 // between the two routes [N m]
  /// Largest difference between the two routes, divided by the largest moment.
  double largest_route_difference() const {
    return largest_component > 0. ? largest_difference / largest_component : 0.;
  }
};

double largest_component(const std::array<double, 3>& v);

/// Appends a moment with the components x, y, z.
void add_moment(const std::array<double, 3>& moment, const std::array<double, 3>& axial,
                MomentRecord& record);
/// Compares a moment from both routes.
void compare_routes(const std::array<double, 3>& moment, const std::array<double, 3>& other,
                    MomentRecord& record);

}  // namespace vibrissa::fem
