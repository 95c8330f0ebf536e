#include "signals/formats/matrix_columns.h"

#include <algorithm>
#include <utility>

namespace vibrissa::signals::formats {

std::vector<NumericColumn> columns_of(NamedArray array) {
  std::vector<std::size_t> lengths;
  for (const std::size_t length : array.shape)
    if (length != 1) lengths.push_back(length);
  if (lengths.size() <= 1)
    return {{std::move(array.name), std::move(array.values), array.single_precision}};
  if (lengths.size() > 2) return {};
  const bool samples_first = lengths[0] >= lengths[1];
  const std::size_t n_samples = samples_first ? lengths[0] : lengths[1];
  const std::size_t n_columns = samples_first ? lengths[1] : lengths[0];
  const bool one_after_another = samples_first == array.first_index_first;
  std::vector<NumericColumn> columns;
  for (std::size_t c = 0; c < n_columns; ++c) {
    NumericColumn column{array.name + "_" + std::to_string(c + 1), {}, array.single_precision};
    column.values.resize(n_samples);
    for (std::size_t i = 0; i < n_samples; ++i)
      column.values[i] = array.values[one_after_another ? c * n_samples + i : i * n_columns + c];
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace vibrissa::signals::formats
