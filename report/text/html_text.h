#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace vibrissa::report {

/// The text as it must stand in HTML, between tags or in a quoted attribute. Proven, as
/// what follows, by tests/report/text/html_text_test.cc.
std::string html_escaped(std::string_view text);

/// An element of this tag with the text, escaped, and a line break.
std::string html_element(const std::string& tag, std::string_view text);

/// JSON that stays within a script element whatever its strings hold: no '<', '>' or '&' as such.
/// Bytes that are no UTF-8 become U+FFFD.
std::string script_json(const nlohmann::json& json);

}  // namespace vibrissa::report
