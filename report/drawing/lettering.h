#pragma once

#include <memory>
#include <string>

typedef struct _PangoLayout PangoLayout;

namespace vibrissa::report {

struct EndOfLayout {
  void operator()(PangoLayout* layout) const;
};

/// The text in DejaVu Sans, or in another font where it has not all characters; size of the letters
/// in pixels. The same in every kind of file. Not for several threads at once.
std::unique_ptr<PangoLayout, EndOfLayout> text_layout(const std::string& text, int size, bool bold);

/// Its width in pixels. Proven by tests/report/drawing/lettering_test.cc.
double text_width(const std::string& text, int size, bool bold);

}  // namespace vibrissa::report
