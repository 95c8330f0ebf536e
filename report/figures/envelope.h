#pragma once

#include <cstddef>
#include <vector>

#include "report/figures/range.h"

namespace vibrissa::report {

/// Points joined by straight lines; a NaN in y is a gap.
struct Polyline {
  std::vector<double> x, y;
};

/// Fewer points that draw the same picture: in every run of finite points inside one of the
/// n_columns pixel columns of x_range the first, lowest, highest and last points remain (M4: Jugel
/// et al. 2014, VLDB 7(10)), so every spike is kept. Points outside belong to a column left or
/// right of the picture. Returns the input unchanged when x is not ascending. x and y are plot
/// coordinates (logarithms on a logarithmic axis); x is finite wherever y is. Proven by
/// tests/report/figures/envelope_test.cc.
Polyline envelope(const Polyline& line, const Range& x_range, std::size_t n_columns);

/// Lower and upper edge of a filled area.
struct Band {
  std::vector<double> x, low, high;
};

/// The same for a band: the lowest of low and the highest of high in each pixel column.
Band band_envelope(const Band& band, const Range& x_range, std::size_t n_columns);

/// The first point in every pixel of a picture of n_columns x n_rows; points outside the ranges and
/// points that are not finite are left out.
Polyline one_point_a_pixel(const Polyline& points, const Range& x_range, const Range& y_range,
                           std::size_t n_columns, std::size_t n_rows);

}  // namespace vibrissa::report
