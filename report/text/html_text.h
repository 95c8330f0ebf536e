#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vibrissa::report {

/// The text escaped for HTML, between tags or in a quoted attribute. Proven, as the functions
/// below, by tests/report/text/html_text_test.cc.
std::string html_escaped(std::string_view text);

/// An HTML element with this tag and the escaped text, followed by a line break.
std::string html_element(const std::string& tag, std::string_view text);

/// JSON that is safe inside a script element: '<', '>' and '&' are escaped. Invalid UTF-8 bytes
/// become U+FFFD.
std::string script_json(const nlohmann::json& json);

}  // namespace vibrissa::report
