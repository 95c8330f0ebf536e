#include "trial/generator/calibration_draw.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::trial {
namespace {

void take_as_built(World& world, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto off = [&](double deviation) {
    return 1. + deviation * std::clamp(normal(random), -2., 2.);
  };
  world.solid.silicone_modulus = off(built_modulus);
  world.damping = off(built_damping);
  world.sensor_gain = off(built_gain);
  world.drag = off(built_drag);
}

void take_as_paper(World& world, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  const auto off = [&](const PaperDistance& range) {
    const double size = range.low + (range.high - range.low) * uniform(random);
    return 1. + (range.either_sign && uniform(random) < 0.5 ? size : -size);
  };
  world.solid.silicone_modulus = off(paper_modulus);
  world.damping = off(paper_damping);
  world.sensor_gain = off(paper_gain);
  world.reference_gain = off(paper_gain);
  world.drag = off(paper_drag);
}

}  // namespace

void draw_calibrations(World& world, const Distance distance, std::mt19937_64& random) {
  if (distance == Distance::as_built) take_as_built(world, random);
  if (distance == Distance::as_paper) take_as_paper(world, random);
}

std::map<std::string, double> calibrations_of(const World& world) {
  return {{"stiffness", world.solid.silicone_modulus},
          {"damping", world.damping},
          {"sensor_gain", world.sensor_gain},
          {"reference_gain", world.reference_gain},
          {"drag_error", world.drag}};
}

std::map<std::string, double> calibration_deviations(const Distance distance) {
  if (distance != Distance::as_paper)
    return {{"stiffness", built_modulus},
            {"damping", built_damping},
            {"sensor_gain", built_gain},
            {"drag_error", built_drag}};
  const auto deviation = [](const PaperDistance& range) {
    const double width = range.high - range.low, middle = 0.5 * (range.low + range.high);
    const double variance = width * width / 12.;
    return std::sqrt(range.either_sign ? middle * middle + variance : variance);
  };
  return {{"stiffness", deviation(paper_modulus)},
          {"damping", deviation(paper_damping)},
          {"sensor_gain", deviation(paper_gain)},
          {"reference_gain", deviation(paper_gain)},
          {"drag_error", deviation(paper_drag)}};
}

}  // namespace vibrissa::trial
