#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Shortest decimal text that reads back to the same double, with a decimal point in every locale.
/// Proven by tests/signals/base/number_text_test.cc.
std::string to_text(double value);

/// Converts the whole text to a number, also "nan" and "inf"; a leading plus is allowed, spaces are
/// not. Returns nothing when the text is not a number or is outside the range of a double.
/// Independent of the locale; proven by tests/signals/base/number_text_test.cc.
std::optional<double> to_number(std::string_view text);

}  // namespace vibrissa::signals
