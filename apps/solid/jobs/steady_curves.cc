#include "apps/solid/jobs/steady_curves.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace vibrissa::apps {

namespace {

constexpr double mn_mm = 1e-6;  // N m

signals::PowerLaw law_of(const std::vector<double>& at, const std::vector<double>& moment) {
  const std::size_t first = at.front() == 0. ? 1 : 0;
  return signals::fit_power_law(std::span(at).subspan(first), std::span(moment).subspan(first));
}

void fit_laws(SteadyCurve& curve) {
  std::vector<double> moment, linear;
  for (const auto& m : curve.moment) {
    moment.push_back(m.base_moment_n_m);
    linear.push_back(m.linear_base_moment_n_m);
  }
  curve.law = law_of(curve.at, moment);
  curve.linear_law = law_of(curve.at, linear);
}

double percent_off(const fem::SteadyMoment& moment) {
  const double linear = moment.linear_base_moment_n_m;
  return linear == 0. ? 0. : 100. * (moment.base_moment_n_m / linear - 1.);
}

void add_curves(report::Panel& panel, const SteadyCurve& curve, const std::string& sensor,
                const std::size_t colour) {
  report::Curve solid{.label = sensor + ", whole solid", .style = report::CurveStyle::points};
  report::Curve linear{.label = sensor + ", linear model"};
  solid.colour = linear.colour = colour;
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    if (curve.at[i] == 0.) continue;  // has no place on a logarithmic axis
    solid.x.push_back(curve.at[i]);
    linear.x.push_back(curve.at[i]);
    solid.y.push_back(std::abs(curve.moment[i].base_moment_n_m) / mn_mm);
    linear.y.push_back(std::abs(curve.moment[i].linear_base_moment_n_m) / mn_mm);
  }
  panel.curves.push_back(std::move(solid));
  panel.curves.push_back(std::move(linear));
}

/// All sensors over one kind of load; a little room beside the outermost points.
report::Panel logarithmic_panel(const std::vector<SteadyCurves>& sensors,
                                SteadyCurve SteadyCurves::*of, const std::string& x_label) {
  constexpr double room = 1.08;
  report::Panel panel;
  panel.x_label = x_label;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const SteadyCurve& curve = sensors[i].*of;
    add_curves(panel, curve, sensors[i].sensor, i);
    panel.title += (i == 0 ? "Exponents: " : ", ") + sensors[i].sensor + " " +
                   report::Cell(curve.law.exponent).rounded(4);
    const auto& x = panel.curves.back().x;
    panel.x_range = report::Range{x.front() / room, x.back() * room};
  }
  panel.y_label = "Base moment [mN mm]";
  panel.log_x = panel.log_y = true;
  return panel;
}

report::Table curve_table(const std::vector<SteadyCurves>& sensors, SteadyCurve SteadyCurves::*of,
                          const report::Column& load) {
  report::Table table({{"sensor", ""},
                       load,
                       {"base moment", "N m"},
                       {"linear base moment", "N m"},
                       {"difference", "%"},
                       {"largest deflection", "m"},
                       {"two routes' difference", ""}});
  for (const auto& sensor : sensors) {
    const SteadyCurve& curve = sensor.*of;
    for (std::size_t i = 0; i < curve.at.size(); ++i) {
      const auto& m = curve.moment[i];
      table.add_row({sensor.sensor, curve.at[i], m.base_moment_n_m, m.linear_base_moment_n_m,
                     percent_off(m), m.largest_deflection_m, m.route_difference});
    }
  }
  return table;
}

nlohmann::json law_json(const signals::PowerLaw& law) {
  return {{"exponent", law.exponent},
          {"half_interval_95", law.half_interval_95},
          {"lowest_local_exponent", law.lowest_local_exponent},
          {"highest_local_exponent", law.highest_local_exponent}};
}

nlohmann::json curve_json(const SteadyCurve& curve, const std::string& load) {
  nlohmann::json points = nlohmann::json::array();
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    points.push_back({{load, curve.at[i]},
                      {"base_moment_n_m", curve.moment[i].base_moment_n_m},
                      {"linear_base_moment_n_m", curve.moment[i].linear_base_moment_n_m},
                      {"largest_deflection_m", curve.moment[i].largest_deflection_m},
                      {"route_difference", curve.moment[i].route_difference}});
  }
  return {
      {"points", points}, {"law", law_json(curve.law)}, {"linear_law", law_json(curve.linear_law)}};
}

}  // namespace

SteadyCurves make_steady_curves(const std::string& name, const fem::SensorParameters& parameters,
                                const std::vector<double>& wind_m_s,
                                const std::vector<double>& acceleration_m_s2,
                                const std::function<void()>& after_each) {
  const fem::Sensor sensor(parameters);
  SteadyCurves curves{name, {}, {}};
  curves.wind.at = wind_m_s;
  curves.wind.moment = fem::steady_wind_moments(sensor, wind_m_s, {}, after_each);
  curves.base.at = acceleration_m_s2;
  curves.base.moment = fem::steady_base_moments(sensor, acceleration_m_s2, {}, after_each);
  fit_laws(curves.wind);
  fit_laws(curves.base);
  return curves;
}

report::Figure steady_figure(const std::vector<SteadyCurves>& sensors) {
  report::Figure figure;
  figure.name = "steady_moments";
  figure.title = "Steady base moment over wind and base acceleration";
  figure.caption =
      "Absolute moments. Points: static equilibrium of the whole solid at finite strain; lines: "
      "the linear model. Quasi-steady drag with Cd(Re) of wire and blades.";
  figure.panels = {
      logarithmic_panel(sensors, &SteadyCurves::wind, "Wind speed [m/s]"),
      logarithmic_panel(sensors, &SteadyCurves::base, "Base acceleration [m/s\u00b2]")};
  return figure;
}

report::Table wind_table(const std::vector<SteadyCurves>& sensors) {
  return curve_table(sensors, &SteadyCurves::wind, {"wind speed", "m/s"});
}

report::Table acceleration_table(const std::vector<SteadyCurves>& sensors) {
  return curve_table(sensors, &SteadyCurves::base, {"base acceleration", "m/s^2"});
}

report::Table exponent_table(const std::vector<SteadyCurves>& sensors) {
  report::Table table({{"sensor", ""},
                       {"moment against", ""},
                       {"exponent", "", 5},
                       {"95 % interval +-", "", 2},
                       {"lowest local", "", 5},
                       {"highest local", "", 5},
                       {"of the linear model", "", 5}});
  for (const auto& sensor : sensors) {
    const auto add = [&](const std::string& against, const SteadyCurve& curve) {
      table.add_row({sensor.sensor, against, curve.law.exponent, curve.law.half_interval_95,
                     curve.law.lowest_local_exponent, curve.law.highest_local_exponent,
                     curve.linear_law.exponent});
    };
    add("wind speed", sensor.wind);
    add("base acceleration", sensor.base);
  }
  return table;
}

nlohmann::json steady_json(const std::vector<SteadyCurves>& sensors) {
  nlohmann::json document{{"sensors", nlohmann::json::array()}};
  for (const auto& sensor : sensors) {
    document["sensors"].push_back(
        {{"sensor", sensor.sensor},
         {"wind", curve_json(sensor.wind, "wind_speed_m_s")},
         {"base_acceleration", curve_json(sensor.base, "base_acceleration_m_s2")}});
  }
  return document;
}

}  // namespace vibrissa::apps
