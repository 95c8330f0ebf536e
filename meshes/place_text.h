#pragma once

#include <deal.II/base/point.h>

#include <string>

namespace vibrissa::meshes {

/// "(x, y, z) m" for messages.
std::string place_text(const dealii::Point<3>& place);

}  // namespace vibrissa::meshes
