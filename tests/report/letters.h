#pragma once

#include <string>

#include "report/drawing/page_layout.h"
#include "report/text/text.h"

namespace vibrissa::report {

/// Wider than the real letters, so that a text that fits here always fits.
inline double wide_letters(const std::string& text, const int size, const bool bold) {
  return (bold ? 0.75 : 0.65) * size * static_cast<double>(n_characters(text));
}

inline Box box_of(const PlacedText& text) {
  const double length = wide_letters(text.text, text.size, text.bold);
  const double before = text.anchor == Anchor::left     ? 0.
                        : text.anchor == Anchor::centre ? length / 2.
                                                        : length;
  const double half = text.size / 2.;
  return text.upward ? Box{text.x - half, text.y - before, 2. * half, length}
                     : Box{text.x - before, text.y - half, length, 2. * half};
}

}  // namespace vibrissa::report
