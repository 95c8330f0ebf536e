#include "signals/files/row_range.h"

#include <charconv>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

std::size_t whole_number(const std::string& text, const std::string& option) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw UserError(option + ": '" + text + "' is not a whole number; write FIRST:LAST");
  }
  return value;
}

}  // namespace

RowRange parse_rows(const std::string& text, const std::string& option) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) {
    throw UserError(option + ": '" + text + "' is not a range; write FIRST:LAST");
  }
  const std::size_t first = whole_number(text.substr(0, colon), option);
  const std::size_t last = whole_number(text.substr(colon + 1), option);
  if (first < 1 || last < first) {
    throw UserError(option + ": rows " + text +
                    " are not a range; write FIRST:LAST with 1 <= FIRST <= LAST");
  }
  return {first, last - first + 1};
}

}  // namespace vibrissa::signals
