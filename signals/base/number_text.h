#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Shortest decimal form that reads back to the same double; with a point whatever the locale is.
/// Proven by tests/signals/base/number_text_test.cc.
std::string to_text(double value);

/// The number that the whole text is, also "nan" and "inf"; a leading plus is allowed, spaces are
/// not. Nothing when the text is no number or lies beyond the range of a double.
/// Independent of the locale; proven by tests/signals/base/number_text_test.cc.
std::optional<double> to_number(std::string_view text);

}  // namespace vibrissa::signals
