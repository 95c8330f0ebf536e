#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/model/chain.h"
#include "signals/model/measuring_chain.h"

namespace vibrissa::diagnosis {

using signals::Link;  // of the measuring chain (docs/effects.md)

/// Prior of a parameter in its fitted coordinate (value or logarithm).
struct Prior {
  enum class Kind { normal, student, uniform } kind = Kind::uniform;
  double centre = 0.;  // of normal and student, in the fitted coordinate
  double scale = 1.;
  double low = 0., high = 1.;      // bounds of the fitted coordinate, for all kinds of priors
  double degrees_of_freedom = 6.;  // of student

  /// Are the bounds equal, so that the parameter has one value?
  bool is_fixed() const { return low == high; }
  /// Fixes the parameter at the centre of its prior; its evidence becomes that of no parameter.
  void fix() { low = high = centre; }
  double log_density(double x) const;
  double slope(double x) const;      // d log_density / dx
  double curvature(double x) const;  // > 0, of the Gaussian that approximates the prior near x

 private:
  struct Shape {
    double log_density, slope, curvature;
  };
  Shape shape(double x) const;
};

/// One parameter of an effect. The fitted coordinate is x = value, or x = ln(value) when
/// logarithmic.
struct Parameter {
  std::string name{}, unit{};
  /// For the unit 1: what the value multiplies, to be read behind it ("of the stiffness").
  std::string relative_to{};
  bool logarithmic = false;
  Prior prior{};
  double neutral = 0.;   // value (not x) at which the effect vanishes
  std::size_t mode = 0;  // acts only where the simulation has at least so many modes
  /// A frequency below Scales::moved_band_hz; data whose band ends below its range do not show it.
  bool in_moved_band = false;
  double step = 1e-4;  // step of x for derivatives
  /// Largest change of x in one iteration of a fit, because basins of attraction may be narrow.
  double largest_step = std::numeric_limits<double>::infinity();

  double value(double x) const { return logarithmic ? std::exp(x) : x; }
  double coordinate(double value) const { return logarithmic ? std::log(value) : value; }
  /// Step of x for a derivative: down where the step up would cross the bound.
  double step_at(double x) const { return x + step > prior.high ? -step : step; }
};
Parameter log_uniform(std::string name, std::string unit, double low, double high, double neutral);
/// The parameter, whose unit is 1, with the text that says what it multiplies.
Parameter relative(std::string to, Parameter parameter);
/// Positive parameter that is usually between two values; heavy tails (Student distribution of ln
/// value with six degrees of freedom).
Parameter log_usual(std::string name, std::string unit, double usual_low, double usual_high,
                    double low, double high, double neutral);
Parameter uniform(std::string name, std::string unit, double low, double high, double neutral);
/// Ratio near one within building tolerances (normal distribution of its logarithm).
Parameter ratio_near_one(std::string name, double relative_scale, double low, double high);
Parameter normal(std::string name, std::string unit, double centre, double scale, double low,
                 double high, double neutral);

/// How a change of the first mode spreads over mode 2, or over mode 3 and those above it: 0 leaves
/// them as they are, 1 changes all alike. No record of the simulation tells it, so its prior is
/// flat.
Parameter spread_over_modes(std::size_t mode);

/// Reference values of the experiment, for parameters.
struct Scales {
  double joint_moment_n_m = 1.;  // peak of the first mode's elastic moment in the fit records
  double duration_s = 1.;        // of the longest fit record
  double first_mode_rad_s = 1.;
  double static_gain = 1.;     // |M / a| at zero frequency, N m / (m/s^2)
  double moment_rms_n_m = 1.;  // largest of the fit records
  double moved_band_hz = 0.;   // below it is nearly all of the base's motion, where it is widest
};

/// What the data must contain so that an effect can be detected.
struct Needs {
  bool base = false, wind = false, cross = false;
  bool repeats = false;  // an accelerometer with sample-and-hold repeats
  double moved_s = 0.;   // least duration of motion in all records together
};

/// One entry of the catalogue of docs/effects.md (equation, sources of ranges and priors, what
/// distinguishes it from similar effects): an extension of the nominal model.
struct Effect {
  std::string id{};
  std::string about{};  // one plain phrase, as in the contents of docs/effects.md
  Link link = Link::structure;
  std::string source{};      // of the equation, which docs/effects.md gives
  bool calibration = false;  // a parameter error: the simulation needs recalibration
  bool irreducible = false;  // adds process noise
  /// Model form error: the true effect may differ from the equation by this share of its influence.
  double model_form_error = 0.01;
  Needs needs{};
  double log_prior = 0.;  // relative to the other effects
  std::vector<Parameter> parameters{};
  /// Starting values (not x), one list per start. At least one start should be in the basin of the
  /// global optimum.
  std::vector<std::vector<double>> starts{};
  /// Further starting values, any number. Only their shapes are compared with the residual of a
  /// fit; a fit also begins from the most similar one at its best size. For basins that are too
  /// narrow for starts, and for effects so weak that every start is too strong.
  std::vector<std::vector<double>> scanned{};
  /// Stiffness of the equivalent linear spring over the nominal one, under random motion whose peak
  /// (Scales::joint_moment_n_m) is three times its root mean square. Fits begin with the measured
  /// resonance, too: with the stiffness divided by it. Roberts and Spanos 1990, *Random Vibration
  /// and Statistical Linearization*, ch. 5.
  std::function<double(std::span<const double> values)> equivalent_stiffness{};
  /// Extends a chain; values are those of the parameters, not x.
  std::function<void(Chain&, std::span<const double> values, const Scales&)> extend{};
};

/// low, low ratio, low ratio^2 ... up to high: starting values for resonance frequencies.
std::vector<double> geometric_series(double low, double high, double ratio);

/// The effect at its first start, on a chain that has only a structure.
Chain probe(const Effect& effect, const NominalModel& structure = {.modes = {{}}});
/// Is the influence of the effect not proportional to the excitation?
bool is_nonlinear(const Effect& effect);

/// Every effect of diagnosis/effects, by id. Proven by
/// tests/diagnosis/effects/effect_catalogue_test.cc.
const std::vector<Effect>& effect_catalogue();
/// nullptr for an unknown id.
const Effect* effect_or_none(const std::string& id);
/// Throws UserError with the known ids for an unknown id.
const Effect& find_effect(const std::string& id);

}  // namespace vibrissa::diagnosis
