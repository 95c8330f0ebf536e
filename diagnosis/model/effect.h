#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/model/chain.h"

namespace vibrissa::diagnosis {

/// Link of the measuring chain (docs/effects.md).
enum class Link { reference, mount, structure, wind, sensor, clock };
std::string to_string(Link link);

/// What is believed of a parameter before the data: in its own value or in its logarithm.
struct Prior {
  enum class Kind { normal, student, uniform } kind = Kind::uniform;
  double centre = 0.;  // normal, student (six degrees of freedom): in the fitted coordinate
  double scale = 1.;
  double low = 0., high = 1.;  // bounds of the fitted coordinate, for all kinds

  double log_density(double x) const;
  double slope(double x) const;      // d log_density / dx
  double curvature(double x) const;  // > 0, the Gaussian that stands for it near x
};

/// One parameter of an effect. Fitted in x = value, or x = ln(value) when positive.
struct Parameter {
  std::string name{}, unit{};
  bool logarithmic = false;
  Prior prior{};
  double neutral = 0.;  // value (not x) at which the nominal model is met exactly
  double step = 1e-4;   // of x, for derivatives
  /// Of x in one iteration of a fit: basins may be narrow.
  double largest_step = std::numeric_limits<double>::infinity();

  double value(double x) const { return logarithmic ? std::exp(x) : x; }
  double coordinate(double value) const { return logarithmic ? std::log(value) : value; }
};
Parameter log_uniform(std::string name, std::string unit, double low, double high, double neutral);
/// Usually between two values, with heavy tails (Student, six degrees of freedom, of ln value).
Parameter log_usual(std::string name, std::string unit, double usual_low, double usual_high,
                    double low, double high, double neutral);
Parameter uniform(std::string name, std::string unit, double low, double high, double neutral);
/// Ratio that is near one, as built (normal, of its logarithm).
Parameter ratio_near_one(std::string name, double relative_scale, double low, double high);
Parameter normal(std::string name, std::string unit, double centre, double scale, double low,
                 double high, double neutral);

/// Magnitudes of the experiment that make parameters dimensionless.
struct Scales {
  double joint_moment_n_m = 1.;  // peak of the first mode's elastic moment in the fit records
  double duration_s = 1.;        // of the longest fit record
  double first_mode_rad_s = 1.;
  double static_gain = 1.;     // |M / a| at zero frequency, N m / (m/s^2)
  double moment_rms_n_m = 1.;  // largest of the fit records
};

/// What the data must hold for an effect to be told.
struct Needs {
  bool base = false, wind = false, cross = false;
  bool repeats = false;  // an accelerometer that is polled faster than it is renewed
  double moved_s = 0.;   // longer than this, all records together
};

/// One entry of the catalogue of docs/effects.md: how the nominal simulator is extended.
struct Effect {
  std::string id{};
  Link link = Link::structure;
  std::string equation{};
  std::string source{};         // of the equation; ranges and priors: docs/effects.md
  std::string confused_with{};  // and what tells apart
  bool calibration = false;     // a mere parameter error: recalibrate
  bool irreducible = false;     // noise of its own
  /// Our form may differ from nature's by this share of what the effect does.
  double model_form_error = 0.01;
  Needs needs{};
  double log_prior = 0.;  // beside that of its fellows
  std::vector<Parameter> parameters{};
  /// Values (not x) to start from, one list a start, aim: some start lies in the basin of the best.
  std::vector<std::vector<double>> starts{};
  /// Further values, however many, whose shape alone is compared with what a fit leaves: from the
  /// most alike, at the size that suits, a fit begins as well. For basins too narrow for starts,
  /// and for effects so weak that any start is too strong.
  std::vector<std::vector<double>> scanned{};
  /// Extends a chain; values as the parameters', not x.
  std::function<void(Chain&, std::span<const double> values, const Scales&)> extend{};
};

/// low, low ratio, low ratio^2 ... up to high: where resonances may be sought.
std::vector<double> geometric_series(double low, double high, double ratio);

/// The effect at its first start, on a chain that is empty otherwise but for its structure.
Chain probe(const Effect& effect, const NominalModel& structure = {.modes = {{}}});
/// Is what the effect does out of proportion to what moves the sensor?
bool is_nonlinear(const Effect& effect);

/// Every effect of diagnosis/effects, one file each, by id. Proven by
/// tests/diagnosis/effects/effect_catalogue_test.cc.
const std::vector<Effect>& effect_catalogue();
/// Throws UserError that lists the known ids.
const Effect& find_effect(const std::string& id);

}  // namespace vibrissa::diagnosis
