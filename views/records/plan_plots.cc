#include "views/records/plan_plots.h"

#include <algorithm>
#include <span>

#include "diagnosis/model/words.h"

namespace vibrissa::views {
namespace {

using diagnosis::EffectPower;
using diagnosis::SensorKind;

/// Number of names that fit on one panel without overlap.
constexpr std::size_t most_names = 16;

/// Effects that the experiment can show, the strongest first.
std::vector<const EffectPower*> by_strength(const diagnosis::ExperimentPlan& plan) {
  std::vector<const EffectPower*> out;
  for (const EffectPower& effect : plan.effects)
    if (effect.shown) out.push_back(&effect);
  std::sort(out.begin(), out.end(), [](const EffectPower* a, const EffectPower* b) {
    return a->on(SensorKind::as_built).nats > b->on(SensorKind::as_built).nats;
  });
  return out;
}

/// The effect, and in brackets the first effect that it may be mistaken for on a sensor with
/// building tolerances.
std::string name_of(const EffectPower& effect) {
  const std::vector<std::string>& alike = effect.on(SensorKind::as_built).alike;
  return alike.empty() ? effect.effect : effect.effect + " (" + alike.front() + "?)";
}

/// Range of all points and of the detection threshold, with a margin at either end.
report::Range evidence_range(std::span<const EffectPower* const> effects) {
  report::Range range{diagnosis::detection_threshold_nats, diagnosis::detection_threshold_nats};
  for (const EffectPower* effect : effects)
    for (const SensorKind kind : diagnosis::sensor_kinds)
      if (const double nats = effect->on(kind).nats; nats > 0.) {
        range.low = std::min(range.low, nats);
        range.high = std::max(range.high, nats);
      }
  return {0.5 * range.low, 2. * range.high};
}

report::Panel strength_panel(std::span<const EffectPower* const> effects,
                             const report::Range& range) {
  report::Panel panel{.title = "Detectability of effects at typical strength",
                      .x_label = "Expected log likelihood ratio [nats]",
                      .log_x = true,
                      .x_range = range};
  for (const SensorKind kind : diagnosis::sensor_kinds) {
    const bool exact = kind == SensorKind::exact;
    report::Curve curve{.label = exact ? "exact simulation" : "building tolerances",
                        .style = report::CurveStyle::points};
    for (std::size_t i = 0; i < effects.size(); ++i) {
      curve.x.push_back(effects[i]->on(kind).nats);
      curve.y.push_back(static_cast<double>(effects.size() - i));
    }
    panel.curves.push_back(std::move(curve));
  }
  for (const EffectPower* effect : effects) panel.y_names.push_back(name_of(*effect));
  std::reverse(panel.y_names.begin(), panel.y_names.end());
  panel.curves.push_back(
      {.label = "detection limit",
       .style = report::CurveStyle::dashed,
       .x = {diagnosis::detection_threshold_nats, diagnosis::detection_threshold_nats},
       .y = {0.5, static_cast<double>(effects.size()) + 0.5}});
  return panel;
}

report::Cell limit_cell(const EffectPower& effect, SensorKind kind) {
  const diagnosis::Detectability& detectability = effect.on(kind);
  return detectability.detected_at_any_size ? report::Cell("any size")
                                            : report::Cell(detectability.limit);
}

}  // namespace

report::Figure plan_figure(const diagnosis::ExperimentPlan& plan) {
  report::Figure figure{.name = "plan",
                        .title = "What the planned experiment can detect",
                        .caption =
                            "An effect right of the detection limit is detected. In brackets: an "
                            "effect that it may be mistaken for."};
  const std::vector<const EffectPower*> effects = by_strength(plan);
  const report::Range range = evidence_range(effects);
  std::span<const EffectPower* const> left = effects;
  for (std::size_t n_panels = (effects.size() + most_names - 1) / most_names; n_panels > 0;
       --n_panels) {
    const std::size_t n = (left.size() + n_panels - 1) / n_panels;
    figure.panels.push_back(strength_panel(left.first(n), range));
    left = left.subspan(n);
  }
  return figure;
}

report::Table limits_table(const diagnosis::ExperimentPlan& plan) {
  report::Table table({{"number", ""},
                       {"effect", ""},
                       {"parameter", ""},
                       {"unit", ""},
                       {"typical", "", 3},
                       {"limit with an exact simulation", "", 3},
                       {"limit with building tolerances", "", 3},
                       {"needs", ""},
                       {"alike with an exact simulation", ""},
                       {"alike with building tolerances", ""}});
  for (std::size_t i = 0; i < plan.effects.size(); ++i) {
    const EffectPower& effect = plan.effects[i];
    table.add_row({i + 1, effect.effect, effect.parameter, effect.unit, effect.typical,
                   limit_cell(effect, SensorKind::exact), limit_cell(effect, SensorKind::as_built),
                   effect.needs, diagnosis::joined(effect.exact.alike, " "),
                   diagnosis::joined(effect.as_built.alike, " ")});
  }
  return table;
}

}  // namespace vibrissa::views
