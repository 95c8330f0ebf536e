#include "meshes/place_text.h"

#include "signals/base/number_text.h"

namespace vibrissa::meshes {

std::string place_text(const dealii::Point<3>& place) {
  std::string text = "(";
  for (unsigned int d = 0; d < 3; ++d)
    text.append(d == 0 ? "" : ", ").append(signals::to_text(place[d]));
  return text.append(") m");
}

}  // namespace vibrissa::meshes
