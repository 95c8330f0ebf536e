#include "diagnosis/records/evaluated_samples.h"

#include <algorithm>
#include <cassert>

#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {

std::vector<double> evaluated_samples(const PreparedRecord& record, std::span<const Complex> bins) {
  assert(bins.size() == record.n_bins());
  std::vector<Complex> whole(record.n_evaluated / 2 + 1, 0.);
  std::copy(bins.begin(), bins.end(), whole.begin() + 1);
  return samples_of(whole, record.n_evaluated);
}

std::vector<Complex> evaluated_bins(const PreparedRecord& record, std::span<const double> samples) {
  const std::vector<Complex> lines = spectrum_of(samples.subspan(record.first, record.n_evaluated));
  return {lines.begin() + 1, lines.end() - 1};
}

std::vector<Complex> bins_of_lines(const PreparedRecord& record,
                                   const std::vector<Complex>& whole) {
  if (record.n_evaluated == record.n_samples) return {whole.begin() + 1, whole.end() - 1};
  return evaluated_bins(record, samples_of(whole, record.n_samples));
}

}  // namespace vibrissa::diagnosis
