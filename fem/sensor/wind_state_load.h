#pragma once

#include "fem/sensor/wind_surface.h"
#include "fem/solid/state_load.h"

namespace vibrissa::fem {

/// Wind speed and base velocity at one instant, along the axial direction.
struct WindInstant {
  double speed_m_s = 0.;          // at the reference height, in the laboratory
  double base_velocity_m_s = 0.;  // of the base, in the laboratory
};

/// Wind load on the deformed sensor (T12.6), or with relative velocity (T6.2), or both: p = 0.5 rho
/// Cd(Re) w|w|, w = u - v, with v the axial velocity of the point in the laboratory (velocity
/// relative to the base plus velocity of the base). Proven by
/// tests/fem/sensor/wind_state_load_test.cc.
class WindStateLoad : public StateLoad {
 public:
  struct Options {
    bool on_deformed_faces = true;
    bool relative_velocity = false;
  };
  /// The surface must outlive the load.
  WindStateLoad(const WindSurface& surface, const Options& options)
      : surface_(surface), options_(options) {}

  void set(const WindInstant& instant) { set(instant, instant, 0.); }
  /// Sets a fraction of the interval between two samples: the pressure is interpolated linearly, as
  /// are the forces and the dynamic pressure of the reduced model.
  void set(const WindInstant& before, const WindInstant& after, double fraction);

  void add_force(const Vector& u, const Vector& v, Vector& force) const override;
  void add_tangent(double factor, const Vector& u, const Vector& v,
                   TangentMatrix& tangent) const override;

 private:
  std::vector<double> pressures(const Vector& v) const;
  std::vector<double> pressures(const WindInstant& instant,
                                const std::vector<double>& axial_velocity) const;

  const WindSurface& surface_;
  Options options_;
  WindInstant before_, after_;
  double fraction_ = 0.;
};

}  // namespace vibrissa::fem
