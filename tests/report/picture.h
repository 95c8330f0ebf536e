#pragma once

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "report/figures/palette.h"

namespace vibrissa::report::testing {

/// A PNG file read back; y counts upward from the lower edge.
class Picture {
 public:
  explicit Picture(const std::filesystem::path& file)
      : image_(cairo_image_surface_create_from_png(file.c_str()), cairo_surface_destroy) {}
  int width() const { return cairo_image_surface_get_width(image_.get()); }
  int height() const { return cairo_image_surface_get_height(image_.get()); }

  Colour at(const int x, const int y) const {
    const unsigned char* const row =
        cairo_image_surface_get_data(image_.get()) +
        (height() - 1 - y) * cairo_image_surface_get_stride(image_.get());
    const std::uint32_t pixel = reinterpret_cast<const std::uint32_t*>(row)[x];
    return {static_cast<unsigned char>(pixel >> 16), static_cast<unsigned char>(pixel >> 8),
            static_cast<unsigned char>(pixel)};
  }

  /// Whether a pixel has nearly this colour.
  bool has(const int x, const int y, const Colour& colour) const {
    const Colour here = at(x, y);
    int difference = 0;
    for (std::size_t c = 0; c < colour.size(); ++c)
      difference = std::max(difference, std::abs(here[c] - colour[c]));
    return difference <= 12;
  }

  /// Whether a pixel at a place in pixels, or one of its neighbours, has nearly this colour.
  bool has_near(const double x, const double y, const Colour& colour) const {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        if (has(static_cast<int>(x) + i, static_cast<int>(y) + j, colour)) return true;
    return false;
  }

  int count(const Colour& colour) const {
    int n = 0;
    for (int x = 0; x < width(); ++x)
      for (int y = 0; y < height(); ++y) n += has(x, y, colour);
    return n;
  }

 private:
  std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image_;
};

}  // namespace vibrissa::report::testing
