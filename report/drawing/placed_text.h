#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vibrissa::report {

enum class Anchor { left, centre, right };

/// A line of text whose anchor (at half its height) is at x, y; a rotated text reads upward.
struct PlacedText {
  std::string text;
  double x, y;
  int size;  // of the letters in pixels
  Anchor anchor = Anchor::left;
  bool bold = false;
  bool upward = false;
};

/// Width of a text in pixels at a letter size.
using TextWidth = std::function<double(const std::string&, int size, bool bold)>;

/// Breaks a text at spaces into lines of at most width pixels (a single word may be wider); a unit
/// in brackets counts as one word.
std::vector<std::string> wrapped(const std::string& text, double width, int size, bool bold,
                                 const TextWidth& text_width);

}  // namespace vibrissa::report
