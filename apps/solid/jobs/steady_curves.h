#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fem/motion/steady_moment.h"
#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "signals/base/power_law.h"

namespace vibrissa::apps {

/// Steady moments of the whole solid at finite strain over one kind of load, ascending.
struct SteadyCurve {
  std::vector<double> at;  // m/s, or m/s^2
  std::vector<fem::SteadyMoment> moment;
  signals::PowerLaw law, linear_law;  // of |moment|, without the point at zero
};

struct SteadyCurves {
  std::string sensor;
  SteadyCurve wind, base;
};

/// Throws UserError as fem::steady_wind_moments does.
SteadyCurves make_steady_curves(const std::string& name, const fem::SensorParameters& parameters,
                                const std::vector<double>& wind_m_s,
                                const std::vector<double>& acceleration_m_s2,
                                const std::function<void()>& after_each);

/// Sizes of the moments over wind and over base acceleration, logarithmic: points of the solid at
/// finite strain, lines of the linear model. Figure 8 of the reference paper.
report::Figure steady_figure(const std::vector<SteadyCurves>& sensors);
report::Table wind_table(const std::vector<SteadyCurves>& sensors);
report::Table acceleration_table(const std::vector<SteadyCurves>& sensors);
report::Table exponent_table(const std::vector<SteadyCurves>& sensors);
nlohmann::json steady_json(const std::vector<SteadyCurves>& sensors);

}  // namespace vibrissa::apps
