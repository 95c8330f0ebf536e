#include "fem/factors/front_elimination.h"

#include <algorithm>

#include "fem/factors/blas.h"

namespace vibrissa::fem {

namespace {

// Size of the tiles of a product, in rows and columns; a tile fills the registers.
constexpr int tile_rows = 24, tile_columns = 8;
// Columns that are eliminated before the rest of the front is touched, and that a product takes at
// once: the packed rows of a tile stay in the first cache.
constexpr int block_width = 48;

#if defined(__x86_64__)
#define VIBRISSA_WIDE_REGISTERS __attribute__((target("avx512f,fma")))

bool processor_has_wide_registers() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma");
}
#else
#define VIBRISSA_WIDE_REGISTERS

bool processor_has_wide_registers() {
  return false;
}
#endif

constexpr int width = 8, registers = tile_rows / width;
using Wide = double __attribute__((vector_size(width * sizeof(double))));
using WideAnywhere =
    double __attribute__((vector_size(width * sizeof(double)), aligned(sizeof(double))));

/// c -= a b^T for one tile; a and b point into packed rows.
VIBRISSA_WIDE_REGISTERS void subtract_tile(const int depth, const double* a, const double* b,
                                           const DenseBlock c) {
  Wide sum[tile_columns][registers] = {};
  for (int k = 0; k < depth; ++k) {
    const auto* const rows = reinterpret_cast<const Wide*>(a);
    const Wide first = rows[0], second = rows[1], third = rows[2];
    for (int column = 0; column < tile_columns; ++column) {
      sum[column][0] += first * b[column];
      sum[column][1] += second * b[column];
      sum[column][2] += third * b[column];
    }
    a += tile_rows;
    b += tile_rows;
  }
  for (int column = 0; column < tile_columns; ++column) {
    auto* const to = reinterpret_cast<WideAnywhere*>(c.at(0, column).data);
    for (int i = 0; i < registers; ++i) to[i] -= sum[column][i];
  }
}

/// The same where only part of the tile is there.
void subtract_part_of_tile(const int n_rows, const int n_columns, const int depth, const double* a,
                           const double* b, const DenseBlock c) {
  alignas(sizeof(Wide)) double whole[tile_rows * tile_columns] = {};
  subtract_tile(depth, a, b, {whole, tile_rows});
  for (int column = 0; column < n_columns; ++column)
    for (int row = 0; row < n_rows; ++row)
      c.at(row, column).data[0] += whole[tile_rows * column + row];
}

/// Rows of a in groups of a tile's, column by column, the last group with zeros.
void pack(const int n_rows, const int depth, const DenseBlock a, double* to) {
  for (int row = 0; row < n_rows; row += tile_rows) {
    const int n = std::min(tile_rows, n_rows - row);
    for (int k = 0; k < depth; ++k, to += tile_rows) {
      const double* const from = a.at(row, k).data;
      std::copy(from, from + n, to);
      std::fill(to + n, to + tile_rows, 0.);
    }
  }
}

int n_tiles(const int n_rows) {
  return (n_rows + tile_rows - 1) / tile_rows;
}

}  // namespace

FrontElimination::FrontElimination(const int most_rows)
    : has_wide_registers_(processor_has_wide_registers()),
      packed_(static_cast<std::size_t>(n_tiles(most_rows)) * tile_rows * block_width) {}

void FrontElimination::subtract_by_tiles(const int n_rows, const int n_columns, const int depth,
                                         const DenseBlock a, const DenseBlock c) {
  pack(n_rows, depth, a, packed_.data());
  const std::ptrdiff_t group = static_cast<std::ptrdiff_t>(tile_rows) * depth;
  for (int row = 0; row < n_rows; row += tile_rows) {
    const double* const rows = packed_.data() + row / tile_rows * group;
    const int n = std::min(tile_rows, n_rows - row);
    const int end = std::min(n_columns, row + tile_rows);
    for (int column = 0; column < end; column += tile_columns) {
      const double* const columns =
          packed_.data() + column / tile_rows * group + column % tile_rows;
      if (n == tile_rows && column + tile_columns <= n_columns) {
        subtract_tile(depth, rows, columns, c.at(row, column));
      } else {
        subtract_part_of_tile(n, std::min(tile_columns, n_columns - column), depth, rows, columns,
                              c.at(row, column));
      }
    }
  }
}

void FrontElimination::subtract_square(const int n_rows, const int n_columns, const int depth,
                                       const DenseBlock a, const DenseBlock c) {
  const double one = 1., minus_one = -1.;
  for (int k = 0; k < depth; k += block_width) {
    const int inner = std::min(block_width, depth - k);
    if (has_wide_registers_) {
      subtract_by_tiles(n_rows, n_columns, inner, a.at(0, k), c);
      continue;
    }
    for (int column = 0; column < n_columns; column += block_width) {
      const int n = std::min(block_width, n_columns - column), rows = n_rows - column;
      const double* const from = a.at(column, k).data;
      dgemm_("N", "T", &rows, &n, &inner, &minus_one, from, &a.stride, from, &a.stride, &one,
             c.at(column, column).data, &c.stride);
    }
  }
}

bool FrontElimination::eliminate(const int n_rows, const int n_columns, const DenseBlock a) {
  const double one = 1.;
  for (int k = 0; k < n_columns; k += block_width) {
    const int n = std::min(block_width, n_columns - k), below = n_rows - k - n;
    const DenseBlock diagonal = a.at(k, k), rest = a.at(k + n, k);
    int status = 0;
    dpotrf_("L", &n, diagonal.data, &a.stride, &status);
    if (status != 0) return false;
    if (below == 0) continue;
    dtrsm_("R", "L", "T", "N", &below, &n, &one, diagonal.data, &a.stride, rest.data, &a.stride);
    subtract_square(below, n_columns - k - n, n, rest, a.at(k + n, k + n));
  }
  return true;
}

}  // namespace vibrissa::fem
