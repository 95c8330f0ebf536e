#pragma once

#include <string>
#include <vector>

#include "signals/formats/numeric_table.h"

namespace vibrissa::signals::formats {

/// An array of a file. Values run along the first index first ("columns in turn", as MATLAB and
/// Fortran keep them) or along the last.
struct NamedArray {
  std::string name;
  std::vector<std::size_t> shape;  // empty: one number
  std::vector<double> values;
  bool single_precision = false;
  bool first_index_first = true;
};

/// A vector (also 1 x n and n x 1) is one column; a matrix has one for each place along its shorter
/// side, named name_1, name_2 and so on; arrays of more indices give none.
/// Proven by tests/signals/formats/numeric_table_test.cc.
std::vector<NumericColumn> columns_of(NamedArray array);

}  // namespace vibrissa::signals::formats
