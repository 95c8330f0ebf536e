#include "diagnosis/judged_samples.h"

#include <algorithm>
#include <cassert>

#include "diagnosis/spectrum.h"

namespace vibrissa::diagnosis {

std::vector<double> judged_samples(const PreparedRecord& record, std::span<const Complex> bins) {
  assert(bins.size() == record.n_bins());
  std::vector<Complex> whole(record.n_judged / 2 + 1, 0.);
  std::copy(bins.begin(), bins.end(), whole.begin() + 1);
  return samples_of(whole, record.n_judged);
}

}  // namespace vibrissa::diagnosis
