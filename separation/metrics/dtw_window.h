#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace vibrissa::separation {

/// Half the width of the band of dtw(); without a window, a width that excludes nothing. Throws
/// UserError as dtw().
std::size_t checked_dtw_window(std::span<const double> x, std::span<const double> y,
                               std::optional<std::size_t> window);

}  // namespace vibrissa::separation
