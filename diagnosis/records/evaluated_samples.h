#pragma once

#include <span>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Samples of a record's evaluated part from its bins (as PreparedRecord::moment), without the mean
/// and the component at half the sampling rate.
std::vector<double> evaluated_samples(const PreparedRecord& record, std::span<const Complex> bins);

/// Bins of the evaluated part, as PreparedRecord::moment, from the samples of a whole record.
std::vector<Complex> evaluated_bins(const PreparedRecord& record, std::span<const double> samples);

/// The same from the lines k = 0 .. n/2 of a whole record.
std::vector<Complex> bins_of_lines(const PreparedRecord& record, const std::vector<Complex>& whole);

}  // namespace vibrissa::diagnosis
