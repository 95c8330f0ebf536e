#include "apps/plan_figures.h"

#include <algorithm>

#include "diagnosis/words.h"

namespace vibrissa::apps {
namespace {

using diagnosis::EffectPower;
using diagnosis::SensorKind;

report::Panel strength_panel(const diagnosis::ExperimentPlan& plan) {
  report::Panel panel{.title = "What would be found at typical strength",
                      .x_label = "Number of the effect",
                      .y_label = "Evidence [nats]",
                      .log_y = true};
  for (const SensorKind kind : diagnosis::sensor_kinds) {
    const bool exact = kind == SensorKind::exact;
    report::Curve curve{.label = exact ? "otherwise as simulated" : "as built",
                        .style = report::CurveStyle::points};
    for (std::size_t i = 0; i < plan.effects.size(); ++i) {
      if (!plan.effects[i].shown) continue;
      curve.x.push_back(static_cast<double>(i + 1));
      curve.y.push_back(plan.effects[i].on(kind).nats);
    }
    panel.curves.push_back(std::move(curve));
  }
  panel.curves.push_back({.label = "needed",
                          .style = report::CurveStyle::dashed,
                          .x = {1., static_cast<double>(plan.effects.size())},
                          .y = {diagnosis::nats_to_find, diagnosis::nats_to_find}});
  return panel;
}

report::Panel pairs_panel(const diagnosis::ExperimentPlan& plan) {
  const auto n = static_cast<double>(plan.effects.size());
  report::Panel panel{.title = "What could be taken for it",
                      .x_label = "Number of the effect",
                      .y_label = "Number of the other",
                      .x_range = report::Range{0., n + 1.},
                      .y_range = report::Range{0., n + 1.}};
  const auto number_of = [&](const std::string& id) {
    const auto found = std::find_if(plan.effects.begin(), plan.effects.end(),
                                    [&](const EffectPower& e) { return e.effect == id; });
    return static_cast<double>(found - plan.effects.begin() + 1);
  };
  for (const SensorKind kind : {SensorKind::as_built, SensorKind::exact}) {
    report::Curve curve{
        .label = kind == SensorKind::exact ? "even if otherwise as simulated" : "as built",
        .style = report::CurveStyle::points};
    for (std::size_t i = 0; i < plan.effects.size(); ++i)
      for (const std::string& rival : plan.effects[i].on(kind).alike) {
        curve.x.push_back(static_cast<double>(i + 1));
        curve.y.push_back(number_of(rival));
      }
    if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
  }
  return panel;
}

report::Cell limit_cell(const EffectPower& effect, SensorKind kind) {
  const diagnosis::Standing& standing = effect.on(kind);
  return standing.any_size ? report::Cell("any size") : report::Cell(standing.limit);
}

}  // namespace

report::Figure plan_figure(const diagnosis::ExperimentPlan& plan) {
  report::Figure figure{.name = "plan",
                        .title = "What the experiment could say",
                        .caption = "Effects by their number in detection_limits.csv.",
                        .panels = {strength_panel(plan)}};
  report::Panel pairs = pairs_panel(plan);
  if (!pairs.curves.empty()) figure.panels.push_back(std::move(pairs));
  return figure;
}

report::Table limits_table(const diagnosis::ExperimentPlan& plan) {
  report::Table table({{"number", ""},
                       {"effect", ""},
                       {"parameter", ""},
                       {"unit", ""},
                       {"typical", "", 3},
                       {"limit otherwise as simulated", "", 3},
                       {"limit as built", "", 3},
                       {"needs", ""},
                       {"could be, otherwise as simulated", ""},
                       {"could be, as built", ""}});
  for (std::size_t i = 0; i < plan.effects.size(); ++i) {
    const EffectPower& effect = plan.effects[i];
    table.add_row({i + 1, effect.effect, effect.parameter, effect.unit, effect.typical,
                   limit_cell(effect, SensorKind::exact), limit_cell(effect, SensorKind::as_built),
                   effect.needs, diagnosis::joined(effect.exact.alike, " "),
                   diagnosis::joined(effect.as_built.alike, " ")});
  }
  return table;
}

}  // namespace vibrissa::apps
