#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "report/drawing/canvas.h"

namespace vibrissa::report {

struct Picture {
  int width = 0, height = 0;  // pixels
  std::string title{}, caption{};
  std::function<void(Canvas&)> paint;
};

/// Writes the picture as PNG, SVG or PDF, by the ending of the file; SVG and PDF keep title and
/// caption as text, and letters as outlines or with their font, so that they look the same in every
/// viewer. The file is complete or does not exist. Throws as signals::write_file(). Proven by
/// tests/report/drawing/draw_test.cc.
void write_picture(const Picture& picture, const std::filesystem::path& file);

}  // namespace vibrissa::report
