#pragma once

#include <array>
#include <vector>

namespace vibrissa::fem {

/// Base moment of a transient at every sample.
struct MomentRecord {
  std::vector<double> base_moment, cross_moment;  // by the clamp's reactions [N m]
  double largest_component = 0.;                  // of the moments that were compared [N m]
  double largest_difference = 0.;                 // between the two routes to them [N m]
  /// Between the two routes, over the largest moment.
  double largest_route_difference() const {
    return largest_component > 0. ? largest_difference / largest_component : 0.;
  }
};

double largest_component(const std::array<double, 3>& v);

/// Appends a moment along x, y, z.
void add_moment(const std::array<double, 3>& moment, const std::array<double, 3>& axial,
                MomentRecord& record);
/// Takes account of a moment by both routes.
void compare_routes(const std::array<double, 3>& moment, const std::array<double, 3>& other,
                    MomentRecord& record);

}  // namespace vibrissa::fem
