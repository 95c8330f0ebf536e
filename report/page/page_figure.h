#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/figures/figure.h"
#include "report/figures/packed_numbers.h"

namespace vibrissa::report {

/// A figure as the page's script draws it: as its file (figure.h), with the number of a list in
/// numbers in place of each list, and of each curve the fields "csv" that stand before its values
/// in to_csv(). Proven by tests/report/page/page_test.cc.
nlohmann::json page_figure(const Figure& figure, PackedNumbers& numbers);

/// What the figure shows, for those who do not see it: a table in HTML with the number of points
/// and the ranges of each curve.
std::string figure_in_words(const Figure& figure);

}  // namespace vibrissa::report
