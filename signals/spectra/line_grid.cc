#include "signals/spectra/line_grid.h"

#include <cmath>
#include <random>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals {

namespace {

constexpr double most_lines = 1 << 22;

void check_band(const GridBand& band) {
  if (!(band.low_hz > 0.) || !(band.high_hz >= band.low_hz) || !std::isfinite(band.high_hz) ||
      !(band.resolution_hz > 0.) || !std::isfinite(band.resolution_hz))
    throw UserError("excitation band " + to_text(band.low_hz) + " .. " + to_text(band.high_hz) +
                    " Hz at a resolution of " + to_text(band.resolution_hz) +
                    " Hz: 0 < low <= high and a positive resolution are needed");
  if (band.high_hz / band.resolution_hz > most_lines)
    throw UserError("excitation band: the band up to " + to_text(band.high_hz) +
                    " Hz at a resolution of " + to_text(band.resolution_hz) + " Hz has more than " +
                    to_text(most_lines) + " lines; take a shorter period");
}

std::vector<GridLine> lines_in(LineGrid grid, const GridBand& band) {
  // A bound that is a multiple but for rounding counts as one.
  const auto first =
      static_cast<std::size_t>(std::ceil(band.low_hz / band.resolution_hz * (1. - 1e-12)));
  const auto last =
      static_cast<std::size_t>(std::floor(band.high_hz / band.resolution_hz * (1. + 1e-12)));
  std::vector<GridLine> lines;
  for (std::size_t k = first; k <= last; ++k) {
    const bool detects = grid != LineGrid::full && k % 2 == 0;
    lines.push_back({k, detects ? LineRole::even_detection : LineRole::excited});
  }
  if (orders_of(lines, LineRole::excited).empty())
    throw UserError("excitation band " + to_text(band.low_hz) + " .. " + to_text(band.high_hz) +
                    " Hz contains no line of the " + name_of(grid) + " grid at a resolution of " +
                    to_text(band.resolution_hz) + " Hz; widen the band or take a longer period");
  return lines;
}

void leave_out_one_of_each_group(std::vector<GridLine>& lines, const GridBand& band) {
  std::vector<GridLine*> odd;
  for (GridLine& line : lines)
    if (line.role == LineRole::excited) odd.push_back(&line);
  if (band.group_size < 2 || odd.size() < band.group_size)
    throw UserError("random-odd grid: " + std::to_string(odd.size()) +
                    " odd lines in the band for groups of " + std::to_string(band.group_size) +
                    "; at least one whole group of at least 2 lines is needed: widen the band or "
                    "take a longer period");
  std::mt19937_64 random(band.seed);
  for (std::size_t start = 0; start + band.group_size <= odd.size(); start += band.group_size)
    odd[start + random() % band.group_size]->role = LineRole::odd_detection;
}

}  // namespace

std::vector<GridLine> grid_lines(LineGrid grid, const GridBand& band) {
  check_band(band);
  std::vector<GridLine> lines = lines_in(grid, band);
  if (grid == LineGrid::random_odd) leave_out_one_of_each_group(lines, band);
  return lines;
}

std::vector<std::size_t> orders_of(const std::vector<GridLine>& lines, LineRole role) {
  std::vector<std::size_t> orders;
  for (const GridLine& line : lines)
    if (line.role == role) orders.push_back(line.order);
  return orders;
}

std::string revelation(LineGrid grid, LineRole role) {
  switch (role) {
    case LineRole::even_detection:
      return "even distortion: an asymmetric law, such as drag u|u| about a mean wind, a one-sided "
             "stop or a squared term";
    case LineRole::odd_detection:
      return "odd distortion: a symmetric law, such as a hardening spring, dry friction, play or "
             "saturation";
    case LineRole::excited:
      break;
  }
  switch (grid) {
    case LineGrid::full:
      return "the response; noise, from the scatter between periods; even and odd distortion "
             "together, from the scatter between realisations";
    case LineGrid::odd:
      return "the response; noise, from the scatter between periods; odd distortion, from the "
             "scatter between realisations";
    case LineGrid::random_odd:
      break;
  }
  return "the response; noise, from the scatter between periods";
}

std::string name_of(LineGrid grid) {
  switch (grid) {
    case LineGrid::full:
      return "full";
    case LineGrid::odd:
      return "odd";
    case LineGrid::random_odd:
      break;
  }
  return "random-odd";
}

std::string name_of(LineRole role) {
  switch (role) {
    case LineRole::excited:
      return "excited";
    case LineRole::even_detection:
      return "even detection";
    case LineRole::odd_detection:
      break;
  }
  return "odd detection";
}

}  // namespace vibrissa::signals
