#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vibrissa::separation {

/// x[first] is matched with y[second].
struct DtwPair {
  std::size_t first = 0, second = 0;
  bool operator==(const DtwPair&) const = default;
};

/// The path whose cost and length dtw() gives, from the first pair to the last. It is exact; when
/// several paths are best, it is one of the shortest and takes diagonal steps as late as possible.
/// Rows of the table are stored at intervals of about four times the square root of their number,
/// and the rows between them are computed again on the way back: memory O(sqrt(length) * window),
/// time twice that of the plain recursion. Throws UserError as dtw() does, and when that memory
/// would be above 512 MB (160 000 samples without a window). Proven by
/// tests/separation/metrics/dtw_path_test.cc against all possible paths, and against dtw().
std::vector<DtwPair> dtw_path(std::span<const double> x, std::span<const double> y,
                              std::optional<std::size_t> window = std::nullopt);

}  // namespace vibrissa::separation
