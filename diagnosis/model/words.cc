#include "diagnosis/model/words.h"

#include <sstream>

namespace vibrissa::diagnosis {
namespace {

std::string with_decimals(const double value, const int most_decimals) {
  std::ostringstream stream;
  stream.precision(most_decimals);
  stream << std::fixed << value;
  std::string text = stream.str();
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

/// Is the space between a value and "%", or in a range "a .. b"?
bool is_within_number(const std::string& text, const std::size_t space) {
  const auto follows = [&](const std::string& word) {
    return text.compare(space + 1, word.size(), word) == 0;
  };
  return follows("%") || follows(".. ") || follows("-> ") ||
         (space >= 2 &&
          (text.compare(space - 2, 2, "..") == 0 || text.compare(space - 2, 2, "->") == 0));
}

}  // namespace

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string with_digits(const double value, const int digits) {
  std::ostringstream stream;
  stream.precision(digits);
  stream << value;
  return stream.str();
}

std::string three_digits(const double value) {
  return with_digits(value, 3);
}

std::string one_decimal(const double value) {
  return with_decimals(value, 1);
}

std::string percent(const double share) {
  return with_decimals(100. * share, share > 0.1 ? 0 : 1) + " %";
}

std::vector<std::string> wrapped(const std::string& line, const std::size_t most_lines,
                                 const std::size_t indentation) {
  constexpr std::size_t longest = 100;
  const std::string dots = " ...";
  const auto cut_of = [](const std::string& text, const std::size_t most) {
    std::size_t space = text.rfind(' ', most);
    while (space != std::string::npos && is_within_number(text, space))
      space = text.rfind(' ', space - 1);
    return space == std::string::npos || space < most / 2 ? most : space;
  };
  std::vector<std::string> lines;
  std::string rest = line;
  while (rest.size() > longest) {
    if (lines.size() + 1 == most_lines) {
      rest = rest.substr(0, cut_of(rest, longest - dots.size())) + dots;
      break;
    }
    const std::size_t cut = cut_of(rest, longest);
    lines.push_back(rest.substr(0, cut));
    rest = std::string(indentation - 1, ' ') + rest.substr(cut);
  }
  lines.push_back(rest);
  return lines;
}

}  // namespace vibrissa::diagnosis
