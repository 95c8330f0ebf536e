#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::separation {

/// First samples of the hits of an impact hammer: the input is at rest but for short pulses, so 99
/// % of its power about its median lie in less than a twentieth of its samples. Pulses closer
/// than a fiftieth of the record are one hit. Empty: the input is no hit. Proven by
/// tests/separation/segments/hit_blocks_test.cc.
std::vector<std::size_t> hits_of(std::span<const double> input);

/// A part of a record, [first, end).
struct Block {
  std::size_t first = 0, end = 0;
};

/// One block for each hit, each starting as long before its hit as the first block does (the
/// pre-trigger of an analyser), but not before the middle between two hits. So recordings that were
/// glued one after the other are told apart. Empty without hits.
std::vector<Block> hit_blocks(std::span<const double> input);

/// The input without what is recorded between the hits (force window).
std::vector<double> pulses_of(std::span<const double> input);

}  // namespace vibrissa::separation
