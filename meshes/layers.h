#pragma once

#include <vector>

namespace vibrissa::meshes {

enum class FineEnd { lower, upper, both };

/// n_layers + 1 strictly increasing heights [m], first and last equal to `lower` and `upper`. The
/// thickness of the layers increases away from the fine end: the local thickness grows by the
/// factor `growth` > 1 over the whole length (over half of it for FineEnd::both),
///   z(s) = lower + (upper - lower) (growth^s - 1) / (growth - 1), s = i / n_layers.
/// The heights of n layers are among those of 2 n layers. tests/meshes/layers_test.cc.
std::vector<double> graded_heights(double lower, double upper, unsigned int n_layers, double growth,
                                   FineEnd fine_end);

}  // namespace vibrissa::meshes
