#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/figures/figure.h"
#include "report/figures/packed_numbers.h"

namespace vibrissa::report {

/// A figure for the page's script: the JSON of figure.h, but with the index of a list in numbers
/// instead of each list, and with the leading CSV fields of each curve in "csv". Proven by
/// tests/report/page/page_test.cc.
nlohmann::json page_figure(const Figure& figure, PackedNumbers& numbers);

/// Text alternative of the figure: an HTML table with the number of points and the ranges of each
/// curve.
std::string figure_in_words(const Figure& figure);

}  // namespace vibrissa::report
