#pragma once

#include <memory>

#include "fem/motion/transient_load.h"
#include "fem/motion/transient_run.h"
#include "fem/sensor/sensor.h"

namespace vibrissa::fem {

struct TransientOptions {
  double spectral_radius = 0.9;
  unsigned int substeps = 1;  // time steps in one sampling interval
  bool check_balance = true;  // also computes the moment by the second route
};

/// Full-order linear response of the sensor at rest: M u'' + C u' + K u = -M r a_b + f(u_wind, u'),
/// modal damping (damping.h), generalised-alpha on the record's clock divided by substeps; one
/// factorisation. The reported acceleration satisfies the equation of motion at every instant:
/// (1-am) a_(n+1) + am a_n = (1-af) u''_(n+1) + af u''_n (Arnold and Bruels 2007). The drag of
/// relative velocity (T6.2) uses the predicted velocity at the end of the step, v_n + h u''_n.
/// Proven by tests/fem/motion/linear_transient_test.cc. The sensor and the data of the input spans
/// must outlive it.
std::unique_ptr<DrivenSensor> drive_linear(const Sensor& sensor, const TransientInput& input,
                                           const TransientOptions& options = {});

/// Simulates the whole record.
TransientOutput simulate_linear(const Sensor& sensor, const TransientInput& input,
                                const TransientOptions& options = {},
                                const TransientObserver& observer = {});

}  // namespace vibrissa::fem
