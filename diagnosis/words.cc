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

}  // namespace vibrissa::diagnosis
