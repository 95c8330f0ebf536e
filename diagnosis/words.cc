#include "diagnosis/words.h"

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

std::vector<std::string> wrapped(const std::string& line) {
  constexpr std::size_t longest = 100;
  if (line.size() <= longest) return {line};
  std::size_t cut = line.rfind(' ', longest);
  if (cut == std::string::npos || cut < longest / 2) cut = longest;
  std::string rest = "   " + line.substr(cut);
  if (rest.size() > longest) rest = rest.substr(0, longest - 3) + "...";
  return {line.substr(0, cut), rest};
}

}  // namespace vibrissa::diagnosis
