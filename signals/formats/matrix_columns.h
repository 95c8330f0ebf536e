#pragma once

#include <string>
#include <vector>

#include "signals/formats/numeric_table.h"

namespace vibrissa::signals::formats {

/// An array of a file. The first index varies fastest (column-major, as in MATLAB and Fortran) or
/// the last one (row-major).
struct NamedArray {
  std::string name;
  std::vector<std::size_t> shape;  // empty: one number
  std::vector<double> values;
  bool single_precision = false;
  bool first_index_first = true;
};

/// Columns of an array. A vector (also 1 x n and n x 1) is one column; a matrix gives one column
/// for each index of its shorter side, with the names name_1, name_2 and so on; arrays with more
/// indices give none. Proven by tests/signals/formats/numeric_table_test.cc.
std::vector<NumericColumn> columns_of(NamedArray array);

}  // namespace vibrissa::signals::formats
