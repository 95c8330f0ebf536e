#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace vibrissa::signals::formats {

/// How a text table separates columns and writes numbers.
struct Spelling {
  /// A comma, semicolon or tab; a blank for runs of blanks and tabs; 0 for a single column.
  char separator = ',';
  char decimal = '.';
  bool operator==(const Spelling&) const = default;
};

/// Splits a line; blanks around fields and quotes are removed. Only a field that starts with a
/// quote may contain the separator. Proven by tests/signals/formats/text_file_test.cc.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);
std::vector<std::string_view> split_line(std::string_view line, char separator);

/// The number in a field. A decimal comma needs a digit on both sides.
std::optional<double> number_in(std::string_view field, char decimal);

/// Seconds since 1970, or since midnight, of a date and time of ISO 8601 ("2024-01-02T10:11:12.5Z",
/// "2024/01/02 10:11:12,5", "10:11:12.5"); also with points between hours, minutes and seconds.
std::optional<double> time_in(std::string_view field);
/// The seconds of such a time as they are printed: "12.5".
std::string_view printed_seconds(std::string_view time);

bool is_blank(std::string_view line);
/// Whether the line begins with # or % or //.
bool is_comment(std::string_view line);
/// The text behind the mark.
std::string_view comment_text(std::string_view line);

}  // namespace vibrissa::signals::formats
