#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fem/base_moment.h"
#include "fem/damping.h"
#include "fem/moment_record.h"
#include "fem/sensor.h"
#include "fem/transient_load.h"

namespace vibrissa::fem {

/// Constants of the generalised-alpha method from its spectral radius at infinite frequency (Chung
/// and Hulbert 1993): second order for any radius in [0, 1]; 1 keeps all energy.
struct GeneralizedAlpha {
  double alpha_m, alpha_f, beta, gamma;
  /// Throws UserError outside [0, 1].
  explicit GeneralizedAlpha(double spectral_radius);
};

struct TransientOptions {
  double spectral_radius = 0.9;
  unsigned int substeps = 1;  // steps of the integrator in one sample
  bool check_balance = true;  // also computes the moment by the second route
};

using TransientOutput = MomentRecord;

/// Called at every sample with its index and the state there.
using TransientObserver = std::function<void(std::size_t, const SolidState&)>;

/// Full-order linear response of the sensor at rest: M u'' + C u' + K u = -M r a_b + f(u_wind, u'),
/// modal damping (damping.h), generalised-alpha on the record's clock divided by substeps; one
/// factorisation. The reported acceleration satisfies the equation of motion at every instant:
/// (1-am) a_(n+1) + am a_n = (1-af) u''_(n+1) + af u''_n (Arnold and Bruels 2007). Drag of relative
/// velocity (T6.2) is that of the velocity foreseen for the step's end, v_n + h u''_n.
/// Proven by tests/fem/linear_transient_test.cc.
TransientOutput simulate_linear(const Sensor& sensor, const TransientInput& input,
                                const TransientOptions& options = {},
                                const TransientObserver& observer = {});

}  // namespace vibrissa::fem
