#include "trial/generator/simulation_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "trial/generator/session.h"
#include "trial/plant/plant.h"

namespace vibrissa::trial {
namespace {

/// The higher modes of a simulation are less certain than the first.
constexpr double higher_in_first = 5.;

/// Directions in which the modes are off; columns: base, tilt, wind, damping.
using Directions = Eigen::MatrixX4d;

Directions draw_directions(const Eigen::Index n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> size(0.5, 1.);
  Directions out(n, 4);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < 4; ++k)
      out(i, k) = (random() % 2 == 0 ? 1. : -1.) * size(random) * (i == 0 ? 1. : higher_in_first);
  // The base gain of the first mode is the product of both; its damping is a calibration.
  out(0, 1) = out(0, 3) = 0.;
  return out;
}

Structure truncated(Structure s, const Eigen::Index n, const bool is_corrected) {
  for (Eigen::VectorXd* of_modes :
       {&s.frequency_rad_s, &s.damping_ratio, &s.base, &s.tilt, &s.wind})
    of_modes->conservativeResize(n);
  if (is_corrected) return s;
  s.first_moment_kg_m = s.tilt.dot(s.base);
  s.inertia_kg_m2 = s.tilt.squaredNorm();
  s.wind_moment = s.tilt.dot(s.wind);
  return s;
}

Structure moved(Structure s, const Directions& along, const double amount) {
  const Eigen::Index n = s.frequency_rad_s.size();
  std::array<Eigen::VectorXd*, 4> of_modes{&s.base, &s.tilt, &s.wind, &s.damping_ratio};
  for (Eigen::Index k = 0; k < 4; ++k)
    of_modes[static_cast<std::size_t>(k)]->array() *= (amount * along.col(k).head(n)).array().exp();
  return s;
}

using Response = std::vector<std::complex<double>>;

/// From base acceleration to moment, over the band of the session.
Response band_response(const Structure& structure) {
  constexpr double line_hz = 0.5;
  const Take band;
  const StateSpace plant = make_plant(structure, {});
  Response out;
  for (double f = band.low_hz; f <= band.high_hz; f += line_hz)
    out.push_back(
        plant.response({0., 2. * std::numbers::pi * f})(output::moment, input::acceleration));
  return out;
}

double difference(const Response& sensor, const Response& simulation) {
  double difference = 0., power = 0.;
  for (std::size_t i = 0; i < sensor.size(); ++i) {
    difference += std::norm(simulation[i] - sensor[i]);
    power += std::norm(sensor[i]);
  }
  return std::sqrt(difference / power);
}

Structure draw_truncated(const Structure& sensor, const Response& response, const double error,
                         std::mt19937_64& random) {
  // Shares of the error beyond this leave too little to the shapes.
  constexpr double largest_share = 0.7;
  std::vector<Structure> possible{sensor};
  for (const Eigen::Index n : {1, 2, 3, 4})
    for (const bool is_corrected : {true, false})
      if (const Structure s = truncated(sensor, n, is_corrected);
          difference(response, band_response(s)) < largest_share * error)
        possible.push_back(s);
  return possible[random() % possible.size()];
}

}  // namespace

double form_error(const Structure& sensor, const Structure& simulation) {
  return difference(band_response(sensor), band_response(simulation));
}

SimulationForm draw_form(const Structure& sensor, const double error, const std::uint64_t seed) {
  if (error == 0.) return {.structure = sensor};
  std::mt19937_64 random(seed);
  const Response response = band_response(sensor);
  const Structure base = draw_truncated(sensor, response, error, random);
  const Directions along = draw_directions(base.frequency_rad_s.size(), random);
  constexpr std::array holds{Hold::band_limited, Hold::linear, Hold::zero_order};
  constexpr int n_halvings = 20;
  double low = 0., high = 0.2;
  for (int i = 0; i < n_halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (difference(response, band_response(moved(base, along, middle))) < error ? low : high) = middle;
  }
  return {.structure = moved(base, along, low), .hold = holds[random() % holds.size()]};
}

nlohmann::json to_json(const SimulationForm& form) {
  return {{"modes", form.structure.frequency_rad_s.size()}, {"hold", to_string(form.hold)}};
}

}  // namespace vibrissa::trial
