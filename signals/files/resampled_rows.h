#pragma once

#include <optional>
#include <string>
#include <vector>

#include "signals/files/record_sources.h"
#include "signals/record/clock.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

/// Records at even times, estimated from rows at uneven times (spectra/uneven_resample.h). The last
/// one of the values are the times. Sets the clock, with the expected error in its words. Throws
/// UserError for times that do not increase, and where no piece is long enough.
std::vector<Record> resampled_records(const std::string& path, const Sources& sources,
                                      const std::vector<std::vector<double>>& values,
                                      double rate_hz, std::optional<Clock>& clock);

}  // namespace vibrissa::signals
