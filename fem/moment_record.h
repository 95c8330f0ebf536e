#pragma once

#include <array>
#include <vector>

namespace vibrissa::fem {

/// Base moment of a transient at every sample.
struct MomentRecord {
  std::vector<double> base_moment, cross_moment;  // by the clamp's reactions [N m]
  double largest_route_difference = 0.;           // between the two routes, over the largest moment
};

double largest_component(const std::array<double, 3>& v);

/// Fills a record from moments along x, y, z.
class MomentRecorder {
 public:
  MomentRecorder(const std::array<double, 3>& axial, MomentRecord& record)
      : axial_(axial), record_(record) {}

  void add(const std::array<double, 3>& moment);
  /// The same moment by the other route.
  void compare(const std::array<double, 3>& moment, const std::array<double, 3>& other);

 private:
  std::array<double, 3> axial_;
  MomentRecord& record_;
  double peak_ = 0., difference_ = 0.;
};

}  // namespace vibrissa::fem
