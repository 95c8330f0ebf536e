#include "meshes/cross_section.h"

#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>

namespace vibrissa::meshes {

namespace {

using Loop = std::vector<unsigned int>;
using dealii::Point;
using dealii::Tensor;

/// Corner of the core / wire radius: about the smallest distortion of both core and ring.
constexpr double core_corner = 0.55;

/// Exact quarter turns keep the section symmetric to the last bit.
template <class Vector>
Vector turned(Vector v, const unsigned int quarter_turns) {
  for (unsigned int i = 0; i < quarter_turns; ++i) {
    const double x = v[0];
    v[0] = -v[1];
    v[1] = x;
  }
  return v;
}

/// -1 ... 1 for i = 0 ... n, odd about the middle to the last bit.
double centred(const unsigned int i, const unsigned int n) {
  return (2. * i - static_cast<double>(n)) / n;
}

/// Point k of 4n on a square of the given half side, equally spaced on each side, from its corner
/// at -45 degrees.
Point<2> on_square(const double half_side, const unsigned int k, const unsigned int n) {
  return turned(Point<2>(half_side, half_side * centred(k % n, n)), k / n);
}

Point<2> on_circle(const double radius, const unsigned int k, const unsigned int n) {
  const double angle = std::numbers::pi / 4. * centred(k % n, n);
  return turned(Point<2>(radius * std::cos(angle), radius * std::sin(angle)), k / n);
}

Point<2> between(const Point<2>& a, const Point<2>& b, const double fraction) {
  return Point<2>((1. - fraction) * a + fraction * b);
}

unsigned int add_vertex(CrossSection& section, const SectionVertex& vertex) {
  section.vertices.push_back(vertex);
  return section.vertices.size() - 1;
}

void add_quads_between(CrossSection& section, const Loop& inner, const Loop& outer, const Part part,
                       const bool closed) {
  assert(inner.size() == outer.size());
  const unsigned int n = inner.size();
  for (unsigned int k = 0; k + (closed ? 0 : 1) < n; ++k)
    section.quads.push_back({{inner[k], outer[k], inner[(k + 1) % n], outer[(k + 1) % n]}, part});
}

/// Adds n_rings closed rings around the loop; position(ring, k) with ring = 1 ... n_rings. Returns
/// the last loop.
Loop add_rings(CrossSection& section, Loop loop, const unsigned int n_rings, const Part part,
               const std::function<Point<2>(unsigned int, unsigned int)>& position) {
  for (unsigned int ring = 1; ring <= n_rings; ++ring) {
    Loop outer(loop.size());
    for (unsigned int k = 0; k < outer.size(); ++k)
      outer[k] = add_vertex(section, {position(ring, k), {}});
    add_quads_between(section, loop, outer, part, true);
    loop = outer;
  }
  return loop;
}

/// Returns the core's edge, counterclockwise from -45 degrees.
Loop add_core(CrossSection& section, const double half_side, const unsigned int n) {
  const auto coordinate = [&](const unsigned int i) { return half_side * centred(i, n); };
  const auto index = [&](const unsigned int i, const unsigned int j) { return j * (n + 1) + i; };
  for (unsigned int j = 0; j <= n; ++j)
    for (unsigned int i = 0; i <= n; ++i)
      add_vertex(section, {Point<2>(coordinate(i), coordinate(j)), {}});
  for (unsigned int j = 0; j < n; ++j)
    for (unsigned int i = 0; i < n; ++i)
      section.quads.push_back(
          {{index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)}, Part::wire});
  Loop edge;
  for (unsigned int j = 0; j < n; ++j) edge.push_back(index(n, j));
  for (unsigned int j = 0; j < n; ++j) edge.push_back(index(n - j, n));
  for (unsigned int j = 0; j < n; ++j) edge.push_back(index(0, n - j));
  for (unsigned int j = 0; j < n; ++j) edge.push_back(index(j, 0));
  return edge;
}

void add_wing(CrossSection& section, const Loop& square, const double thickness,
              const unsigned int side, const unsigned int n) {
  Loop root(n + 1);
  for (unsigned int j = 0; j <= n; ++j) root[j] = square[(side * n + j) % (4 * n)];
  for (unsigned int row = 1; row <= n; ++row) {
    const double fraction = static_cast<double>(row) / n;
    Loop next(n + 1);
    for (unsigned int j = 0; j <= n; ++j) {
      const double across = 0.5 * thickness * centred(j, n);
      next[j] =
          add_vertex(section, {turned(Point<2>(0.5 * thickness * (1. - fraction), across), side),
                               turned(Tensor<1, 2>({0.5 * fraction, 0.}), side)});
    }
    add_quads_between(section, root, next, Part::fin, false);
    root = next;
  }
}

}  // namespace

CrossSection make_wire_section(const double wire_diameter, const unsigned int n) {
  const double radius = 0.5 * wire_diameter;
  const double half_side = core_corner * radius / std::numbers::sqrt2;
  CrossSection section;
  const Loop core_edge = add_core(section, half_side, n);
  section.wire_circle = add_rings(
      section, core_edge, n, Part::wire, [&](const unsigned int ring, const unsigned int k) {
        return between(on_square(half_side, k, n), on_circle(radius, k, n),
                       static_cast<double>(ring) / n);
      });
  return section;
}

void add_base_rings(CrossSection& section, const double base_diameter, const unsigned int n) {
  const unsigned int n_rings = 2 * n;
  const double inner = section.vertices[section.wire_circle.front()].at_zero_width.norm();
  const double outer = 0.5 * base_diameter;
  add_rings(section, section.wire_circle, n_rings, Part::base,
            [&](const unsigned int ring, const unsigned int k) {
              const double fraction = static_cast<double>(ring) / n_rings;
              return on_circle(inner * std::pow(outer / inner, fraction), k, n);
            });
}

void add_blades(CrossSection& section, const double thickness, const FinShape shape,
                const unsigned int n) {
  assert(shape != FinShape::none);
  std::vector<Point<2>> circle;
  for (const unsigned int v : section.wire_circle)
    circle.push_back(section.vertices[v].at_zero_width);
  const Loop square = add_rings(section, section.wire_circle, n, Part::fin,
                                [&](const unsigned int ring, const unsigned int k) {
                                  return between(circle[k], on_square(0.5 * thickness, k, n),
                                                 static_cast<double>(ring) / n);
                                });
  for (unsigned int side = 0; side < 4; ++side)
    if (shape == FinShape::cross || side % 2 == 1) add_wing(section, square, thickness, side, n);
}

}  // namespace vibrissa::meshes
