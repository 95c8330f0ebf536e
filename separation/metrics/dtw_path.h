#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vibrissa::separation {

/// x[first] is laid beside y[second].
struct DtwPair {
  std::size_t first = 0, second = 0;
  bool operator==(const DtwPair&) const = default;
};

/// The path that dtw() gives cost and length of, from the first pair to the last: exact, of several
/// best paths one of the shortest, which takes the diagonal step as late as it can. Rows of the
/// table are kept at intervals of about four times the root of their number, and what lies between
/// two of them is done again on the way back: memory O(sqrt(length) * window), time twice that of
/// the plain recursion. Throws UserError as dtw() does, and when that memory would be above 512 MB
/// (160 000 samples without a window). Proven by tests/separation/metrics/dtw_path_test.cc against
/// every path there is, and against dtw().
std::vector<DtwPair> dtw_path(std::span<const double> x, std::span<const double> y,
                              std::optional<std::size_t> window = std::nullopt);

}  // namespace vibrissa::separation
