#include "diagnosis/model/words.h"

#include <sstream>

namespace vibrissa::diagnosis {

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

std::string percent(const double share) {
  std::ostringstream stream;
  stream.precision(share > 0.1 ? 0 : 1);
  stream << std::fixed << 100. * share << " %";
  return stream.str();
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
