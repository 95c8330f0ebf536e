#pragma once

#include <array>
#include <vector>

#include "separation/model/input_hold.h"

namespace vibrissa::separation {

/// The course of the base acceleration from one output sample to the next, as straight pieces
/// between values that are weighted sums of three knots:
///   held inputs: the samples u[n-2], u[n-1], u[n];
///   band_limited: node[n-1], midpoint[n-1], node[n] of the InputShaper.
/// The output n lies at (n - fraction) / rate, so that with a fraction two straight lines follow
/// each other. Proven by tests/separation/nonlinear/nonlinear_bank_test.cc.
struct InputPath {
  using Knots = std::array<double, 3>;
  struct Piece {
    double share = 1.;  // of the sampling interval
    Knots start{}, end{};
  };
  std::vector<Piece> pieces;
  Knots direct{};  // weights of the direct term's input, for held inputs

  InputPath(Hold hold, double fraction);
};

inline double weighted(const InputPath::Knots& weights, const InputPath::Knots& knots) {
  return weights[0] * knots[0] + weights[1] * knots[1] + weights[2] * knots[2];
}

}  // namespace vibrissa::separation
