#pragma once

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "report/figures/palette.h"

namespace vibrissa::report::testing {

/// A PNG file read back; y counts upward from the lower edge.
class Picture {
 public:
  explicit Picture(const std::filesystem::path& file) {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    image_ = reader->GetOutput();
  }
  int width() const { return image_->GetDimensions()[0]; }
  int height() const { return image_->GetDimensions()[1]; }

  Colour at(const int x, const int y) const {
    const auto* pixel = static_cast<const unsigned char*>(image_->GetScalarPointer(x, y, 0));
    return {pixel[0], pixel[1], pixel[2]};
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
  vtkSmartPointer<vtkImageData> image_;
};

}  // namespace vibrissa::report::testing
