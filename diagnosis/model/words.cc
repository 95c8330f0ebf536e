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

}  // namespace

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string three_digits(const double value) {
  std::ostringstream stream;
  stream.precision(3);
  stream << value;
  return stream.str();
}

std::string one_decimal(const double value) {
  return with_decimals(value, 1);
}

std::string percent(const double share) {
  return with_decimals(100. * share, share > 0.1 ? 0 : 1) + " %";
}

std::vector<std::string> wrapped(const std::string& line, const std::size_t most_lines) {
  constexpr std::size_t longest = 100;
  const std::string dots = " ...";
  const auto cut_of = [](const std::string& text, const std::size_t most) {
    const std::size_t space = text.rfind(' ', most);
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
    rest = "   " + rest.substr(cut);
  }
  lines.push_back(rest);
  return lines;
}

}  // namespace vibrissa::diagnosis
