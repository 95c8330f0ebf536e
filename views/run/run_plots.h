#pragma once

#include <vector>

#include "case/rig.h"
#include "report/figures/figure.h"
#include "views/records/separation_scores.h"

namespace vibrissa::views {

/// Base acceleration, wind speed and measured moment of the record with base vibration and wind.
report::Figure records_figure(const sensor_case::RigRecords& records);

/// True wind moment and vibration moment with each method's estimates: the wind moment over the
/// whole record, and both over its middle second.
report::Figure separation_figure(const sensor_case::RigRecords& records,
                                 const std::vector<SeparatedSignal>& signals);

/// Power spectral densities of the measured moment, of the true wind moment and of the estimates.
report::Figure spectra_figure(const sensor_case::RigRecords& records,
                              const std::vector<SeparatedSignal>& signals);

}  // namespace vibrissa::views
