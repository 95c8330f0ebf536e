#pragma once

#include <span>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Samples of a record's judged part from its bins (PreparedRecord::moment and what is shaped
/// alike), without their mean and what is at half the rate.
std::vector<double> judged_samples(const PreparedRecord& record, std::span<const Complex> bins);

/// Bins of the judged part, as PreparedRecord::moment, of the samples of a whole record.
std::vector<Complex> judged_bins(const PreparedRecord& record, std::span<const double> samples);

}  // namespace vibrissa::diagnosis
