#include "trial/generator/unknowns.h"

#include <algorithm>
#include <cmath>

#include "signals/base/error.h"

namespace vibrissa::trial {
namespace {

/// Usual peak moments of the nominal sensor at the higher level.
constexpr double peak_moment = 6e-4, first_moment = 2.28e-5;

double hum_frequency(const double shape) {
  constexpr double lines[] = {50.03, 59.98, 100.06, 119.96};
  return lines[static_cast<int>(shape * 3.999)];
}

std::vector<Unknown> structural() {
  return {{.id = "stiffness",
           .unit = "of the silicone's modulus",
           .start = 0.01,
           .largest = 0.4,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.solid.silicone_modulus *= 1. + s; }},
          {.id = "damping",
           .unit = "of the damping",
           .start = 0.05,
           .largest = 0.7,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.damping *= 1. + s; }},
          {.id = "mass",
           .unit = "of the fin's density",
           .start = 0.02,
           .largest = 0.3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.solid.fin_density *= 1. + s; }},
          {.id = "hardening",
           .unit = "of k at a usual peak",
           .start = 0.02,
           .largest = 0.3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.joint.stiffening = s; }},
          {.id = "viscoelastic",
           .unit = "of k",
           .start = 0.02,
           .largest = 0.5,
           .apply = [](World& w, double s, double) { w.joint.branches = s; }},
          {.id = "softening_history",
           .unit = "of k",
           .start = 0.02,
           .largest = 0.4,
           .apply = [](World& w, double s, double) { w.joint.softening = s; }},
          {.id = "temperature_drift",
           .unit = "of k",
           .start = 0.01,
           .largest = 0.3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.joint.warming = s; }},
          {.id = "joint_friction",
           .unit = "of a usual peak",
           .start = 0.01,
           .largest = 0.5,
           .apply =
               [](World& w, double s, double shape) {
                 w.joint.friction_moment = s * peak_moment;
                 w.joint.friction_stiffness = 0.1 + 0.5 * shape;
               }},
          {.id = "backlash",
           .unit = "rad",
           .start = 1e-4,
           .largest = 2e-3,
           .apply = [](World& w, double s, double) { w.joint.dead_zone = s; }},
          {.id = "extra_mode",
           .unit = "of the static gain",
           .start = 0.01,
           .largest = 0.1,
           .either_sign = true,
           .apply = [](World& w, double s, double shape) {
             w.extra_hz = 60. + 100. * shape;
             w.extra_residue = s;
           }}};
}

std::vector<Unknown> of_the_mount() {
  return {{.id = "base_compliance",
           .unit = "of the hinge's compliance",
           .start = 0.02,
           .largest = 0.8,
           .apply = [](World& w, double s, double) { w.base_compliance = s; }},
          {.id = "mount_compliance",
           .unit = "of that of 60 Hz",
           .start = 0.1,
           .largest = 1.,
           .apply = [](World& w, double s, double) { w.mount_hz = 60. / std::sqrt(s); }},
          {.id = "stage_rocking",
           .unit = "rad/m",
           .start = 0.2,
           .largest = 5.,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.rocking = s; }}};
}

std::vector<Unknown> of_the_wind() {
  return {{.id = "relative_drag",
           .unit = "of the own motion",
           .start = 0.5,
           .largest = 2.5,
           .apply = [](World& w, double s, double) { w.own_motion = s; }},
          {.id = "drag_error",
           .unit = "of the drag",
           .start = 0.05,
           .largest = 0.5,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.drag *= 1. + s; }},
          {.id = "flow_lag",
           .unit = "s",
           .start = 5e-3,
           .largest = 0.2,
           .apply = [](World& w, double s, double) { w.flow_lag_s = s; }},
          {.id = "vortex_shedding",
           .unit = "force coefficient",
           .start = 0.1,
           .largest = 1.,
           .random = true,
           .apply = [](World& w, double s, double) { w.shedding = s; }},
          {.id = "turbulence",
           .unit = "intensity",
           .start = 0.03,
           .largest = 0.3,
           .random = true,
           .apply = [](World& w, double s, double) { w.unseen = s; }}};
}

std::vector<Unknown> of_the_reference() {
  return {{.id = "reference_gain",
           .unit = "of the gain",
           .start = 0.01,
           .largest = 0.2,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.reference_gain *= 1. + s; }},
          {.id = "reference_noise",
           .unit = "m/s^2",
           .start = 0.05,
           .largest = 1.,
           .random = true,
           .apply = [](World& w, double s, double) { w.reference_noise = s; },
           // Additional noise of a quiet accelerometer, up to the largest usual noise.
           .hidden_below =
               [](const World& plain) {
                 const double loudest = loudest_accelerometer, usual = plain.acceleration_noise;
                 return std::sqrt(std::max(0., loudest * loudest - usual * usual));
               }},
          {.id = "reference_highpass",
           .unit = "Hz",
           .start = 0.2,
           .largest = 5.,
           .apply = [](World& w, double s, double) { w.reference_highpass_hz = s; }},
          {.id = "cross_axis",
           .unit = "of the axial gain",
           .start = 0.05,
           .largest = 0.3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.cross_axis = s; }},
          {.id = "sample_repeat",
           .unit = "there",
           .start = 1.,
           .largest = 1.,
           .fixed_size = true,
           .apply = [](World& w, double, double shape) {
             w.read_rate_hz = shape < 0.5 ? 400. : 800.;
           }}};
}

std::vector<Unknown> of_the_sensor() {
  return {{.id = "sensor_gain",
           .unit = "of the gain",
           .start = 0.01,
           .largest = 0.25,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.sensor_gain *= 1. + s; }},
          {.id = "sensor_nonlinearity",
           .unit = "of a usual peak",
           .start = 0.01,
           .largest = 0.3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.field_curvature = s / (2. * peak_moment); }},
          {.id = "coil_feedthrough",
           .unit = "of the static gain",
           .start = 0.02,
           .largest = 0.5,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.feedthrough = s * first_moment; }},
          {.id = "sensor_drift",
           .unit = "N m/s",
           .start = 1e-7,
           .largest = 2e-5,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.ramp = s; }},
          {.id = "hum",
           .unit = "N m",
           .start = 2e-7,
           .largest = 5e-5,
           .random = true,
           .apply =
               [](World& w, double s, double shape) {
                 w.hum = s;
                 w.hum_hz = hum_frequency(shape);
               }},
          {.id = "delay",
           .unit = "s",
           .start = 1e-4,
           .largest = 4e-3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.delay_s = s; }},
          {.id = "sensor_lowpass",
           .unit = "s of conversion",
           .start = 1e-3,
           .largest = 8e-3,
           .apply = [](World& w, double s, double) { w.conversion_s = s; }},
          {.id = "clock_drift",
           .unit = "of the rate",
           .start = 2e-5,
           .largest = 1e-3,
           .either_sign = true,
           .apply = [](World& w, double s, double) { w.rate_error = s; }}};
}

}  // namespace

const std::vector<Unknown>& named_unknowns() {
  static const std::vector<Unknown> all = [] {
    std::vector<Unknown> out;
    for (const auto& part :
         {structural(), of_the_mount(), of_the_wind(), of_the_reference(), of_the_sensor()})
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }();
  return all;
}

const std::vector<Unknown>& nameless_unknowns() {
  static const std::vector<Unknown> all{
      {.id = "stop_on_one_side",
       .unit = "of four usual peaks",
       .start = 0.3,
       .largest = 0.9,
       // The stop is out of reach at first.
       .apply = [](World& w, double s, double) { w.joint.stop = 4. * (1. - s) * w.joint.scale; }},
      {.id = "loose_contact",
       .unit = "of the gain",
       .start = 0.02,
       .largest = 0.5,
       .random = true,
       .apply = [](World& w, double s, double) { w.loose_gain = s; }},
      {.id = "wind_pickup",
       .unit = "N m per m/s",
       .start = 1e-6,
       .largest = 3e-5,
       .either_sign = true,
       .apply = [](World& w, double s, double) { w.wind_pickup = s; }},
      {.id = "coarse_converter",
       .unit = "N m",
       .start = 3e-6,
       .largest = 1e-4,
       .random = true,
       .apply = [](World& w, double s, double) { w.step_size = s; }},
      {.id = "slow_amplifier",
       .unit = "of a usual slope",
       .start = 0.3,
       .largest = 3.,
       .apply = [](World& w, double s, double) { w.slew = peak_moment * 235. / s; }},
      {.id = "shaken_along",
       .unit = "of k at a usual peak",
       .start = 0.02,
       .largest = 0.5,
       .either_sign = true,
       .apply = [](World& w, double s, double) { w.joint.parametric = s / 13.; }},
      {.id = "soft_glue",
       .unit = "of the gain at 70 Hz",
       .start = 0.05,
       .largest = 1.,
       .either_sign = true,
       .apply = [](World& w, double s, double) { w.cable_peak = s; }},
      {.id = "quadratic_damping",
       .unit = "of k at a usual rate",
       .start = 0.02,
       .largest = 0.5,
       .apply = [](World& w, double s, double) {
         const double rate = 235. * w.joint.scale;
         w.joint.quadratic_damping = s * w.joint.scale / (rate * rate);
       }}};
  return all;
}

const Unknown& find_unknown(const std::string& id) {
  for (const auto* list : {&named_unknowns(), &nameless_unknowns()})
    for (const Unknown& unknown : *list)
      if (unknown.id == id) return unknown;
  throw signals::UserError("the generator of trials has no effect \"" + id + "\"");
}

}  // namespace vibrissa::trial
