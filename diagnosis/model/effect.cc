#include "diagnosis/model/effect.h"

#include <algorithm>
#include <numbers>

#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// Logarithm of the denominator of Student's density at zero, scale 1.
double student_log_norm(const double dof) {
  return 0.5 * std::log(dof * std::numbers::pi) + std::lgamma(0.5 * dof) -
         std::lgamma(0.5 * (dof + 1.));
}

/// Positive parameter between two values, with a prior of its logarithm.
Parameter logarithmic(std::string name, std::string unit, Prior prior, const double low,
                      const double high, const double neutral) {
  prior.low = std::log(low);
  prior.high = std::log(high);
  return {.name = std::move(name),
          .unit = std::move(unit),
          .logarithmic = true,
          .prior = prior,
          .neutral = neutral};
}

}  // namespace

Prior::Shape Prior::shape(const double x) const {
  const double z = (x - centre) / scale, dof = degrees_of_freedom;
  switch (kind) {
    case Kind::normal:
      return {-0.5 * z * z - std::log(scale * std::sqrt(2. * std::numbers::pi)), -z / scale,
              1. / (scale * scale)};
    case Kind::student:
      return {-0.5 * (dof + 1.) * std::log1p(z * z / dof) - std::log(scale) - student_log_norm(dof),
              -(dof + 1.) * z / (dof + z * z) / scale,
              (dof + 1.) / (dof + z * z) / (scale * scale)};
    case Kind::uniform:
      // Curvature of the Gaussian with the same variance, so that the posterior is never wider than
      // the prior.
      return {-std::log(high - low), 0., 12. / ((high - low) * (high - low))};
  }
  return {};
}

double Prior::log_density(const double x) const {
  return is_fixed() ? 0. : shape(x).log_density;
}

double Prior::slope(const double x) const {
  return shape(x).slope;
}

double Prior::curvature(const double x) const {
  // Cancels the power of 2 pi that Laplace's approximation adds for each parameter.
  return is_fixed() ? 2. * std::numbers::pi : shape(x).curvature;
}

Parameter log_uniform(std::string name, std::string unit, const double low, const double high,
                      const double neutral) {
  return logarithmic(std::move(name), std::move(unit), {}, low, high, neutral);
}

Parameter uniform(std::string name, std::string unit, const double low, const double high,
                  const double neutral) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .prior = {.kind = Prior::Kind::uniform, .centre = neutral, .low = low, .high = high},
          .neutral = neutral,
          .step = 1e-4 * (high - low)};
}

Parameter relative(std::string to, Parameter parameter) {
  parameter.relative_to = std::move(to);
  return parameter;
}

Parameter log_usual(std::string name, std::string unit, const double usual_low,
                    const double usual_high, const double low, const double high,
                    const double neutral) {
  return logarithmic(std::move(name), std::move(unit),
                     {.kind = Prior::Kind::student,
                      .centre = 0.5 * std::log(usual_low * usual_high),
                      .scale = 0.25 * std::log(usual_high / usual_low)},
                     low, high, neutral);
}

Parameter ratio_near_one(std::string name, const double relative_scale, const double low,
                         const double high) {
  return relative(
      "times the simulated value",
      logarithmic(std::move(name), "1", {.kind = Prior::Kind::normal, .scale = relative_scale}, low,
                  high, 1.));
}

Parameter normal(std::string name, std::string unit, const double centre, const double scale,
                 const double low, const double high, const double neutral) {
  return {.name = std::move(name),
          .unit = std::move(unit),
          .prior = {.kind = Prior::Kind::normal,
                    .centre = centre,
                    .scale = scale,
                    .low = low,
                    .high = high},
          .neutral = neutral,
          .step = 1e-3 * scale};
}

Parameter spread_over_modes(const std::size_t mode) {
  Parameter out = uniform("spread_to_mode_" + std::to_string(mode), "1", -0.25, 1.25, 0.5);
  out.step = 1e-3;
  out.mode = mode;
  return out;
}

std::vector<double> geometric_series(const double low, const double high, const double ratio) {
  std::vector<double> out;
  for (double value = low; value <= high; value *= ratio) out.push_back(value);
  return out;
}

Chain probe(const Effect& effect, const NominalModel& structure) {
  Chain chain{.structure = structure};
  effect.extend(chain, effect.starts.front(), {});
  return chain;
}

bool is_nonlinear(const Effect& effect) {
  const Chain chain = probe(effect);
  // Sample-and-hold repeats alias lines onto others.
  const bool folds = chain.new_sample_share > 0.;
  return !chain.joint.empty() || !chain.readout.empty() || chain.relative_wind.on || folds;
}

const Effect* effect_or_none(const std::string& id) {
  const std::vector<Effect>& effects = effect_catalogue();
  const auto found = std::ranges::find(effects, id, &Effect::id);
  return found != effects.end() ? &*found : nullptr;
}

const Effect& find_effect(const std::string& id) {
  if (const Effect* effect = effect_or_none(id)) return *effect;
  std::vector<std::string> known;
  for (const Effect& effect : effect_catalogue()) known.push_back(effect.id);
  throw signals::UserError(signals::unknown_name("effect", id, known));
}

}  // namespace vibrissa::diagnosis
