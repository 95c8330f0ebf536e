#include "views/records/identification_report.h"

#include <cmath>

namespace vibrissa::views {

namespace {

std::string plane_text(const std::vector<separation::PlaneEstimate>& points) {
  const auto number = [](const double value) { return report::Cell(value).rounded(4); };
  std::string text;
  for (const auto& point : points) {
    text += (text.empty() ? "" : "; ") + number(point.value.real()) + " ± " +
            number(point.real_deviation);
    if (point.value.imag() != 0.) {
      text += ", j(" + number(point.value.imag()) + " ± " + number(point.imaginary_deviation) + ")";
    }
  }
  return text.empty() ? "none" : text;
}

report::Table table_of(const std::vector<separation::ModeEstimate>& modes,
                       const std::string& gain_unit) {
  report::Table table({{"mode", ""},
                       {"frequency", "Hz", 6},
                       {"± sd", "Hz", 2},
                       {"damping ratio", ""},
                       {"± sd", "", 2},
                       {"static gain", gain_unit},
                       {"± sd", gain_unit, 2}});
  std::size_t number = 0;
  for (const auto& mode : modes) {
    table.add_row({++number, mode.frequency_hz.value, mode.frequency_hz.standard_deviation,
                   mode.damping_ratio.value, mode.damping_ratio.standard_deviation,
                   mode.static_gain_kg_m.value, mode.static_gain_kg_m.standard_deviation});
  }
  return table;
}

std::string frequency_text(const separation::Estimate& frequency_hz) {
  return report::Cell(frequency_hz.value).rounded(6) +
         (std::isfinite(frequency_hz.standard_deviation)
              ? " ± " + report::Cell(frequency_hz.standard_deviation).rounded(2)
              : "") +
         " Hz";
}

}  // namespace

report::Table identification_table(const separation::FittedBvrm& fit) {
  return table_of(fit.modes, separation::moment_gain_unit);
}

std::string verdict_text(const separation::FittedBvrm& fit, const separation::Verdict& verdict,
                         const std::string& gain_unit) {
  std::vector<separation::ModeEstimate> modes;
  for (const std::size_t k : verdict.determined) modes.push_back(fit.modes[k]);
  std::string text = verdict.sentence + "\n";
  if (!modes.empty()) text += table_of(modes, gain_unit).to_text();
  for (const auto& entry : verdict.frequency_only)
    text +=
        "frequency only: " + frequency_text(frequency_of(entry, fit)) + ": " + entry.reason + "\n";
  for (const auto& entry : verdict.undetermined) {
    const auto& mode = fit.modes[entry.mode];
    text += "not determined: " + frequency_text(mode.frequency_hz) +
            (entry.damping_is_resolved
                 ? ", damping ratio " + report::Cell(mode.damping_ratio.value).rounded(4)
                 : "") +
            ": " + entry.reason + "\n";
  }
  return text;
}

report::Table output_only_table(const separation::OutputOnlyIdentification& found) {
  report::Table table({{"kind", ""},
                       {"frequency", "Hz", 6},
                       {"± sd", "Hz", 2},
                       {"damping ratio", ""},
                       {"± sd", "", 2},
                       {"number of model orders", ""}});
  for (const auto& mode : found.modes) {
    table.add_row({"mode", mode.frequency_hz.value, mode.frequency_hz.standard_deviation,
                   mode.damping_ratio.value, mode.damping_ratio.standard_deviation, mode.n_orders});
  }
  for (const auto& line : found.undamped_hz) {
    table.add_row({"undamped line", line.value, line.standard_deviation, report::Cell(),
                   report::Cell(), report::Cell()});
  }
  return table;
}

report::Table ring_down_table(const separation::RingDown& found) {
  report::Table table({{"from", ""},
                       {"amplitude", found.unit, 3},
                       {"frequency", "Hz", 6},
                       {"± sd", "Hz", 2},
                       {"damping ratio", "", 4},
                       {"± sd", "", 2}});
  const auto add = [&](const std::string& from, const std::vector<separation::DecayPoint>& points) {
    for (const separation::DecayPoint& point : points)
      table.add_row({from, point.amplitude_n_m, point.frequency_hz.value,
                     point.frequency_hz.standard_deviation, point.damping_ratio.value,
                     point.damping_ratio.standard_deviation});
  };
  add("law", found.fitted);
  add("without a law", found.measured);
  return table;
}

std::string evidence_text(const separation::ModelEvidence& evidence) {
  const std::string poles = "poles [rad/s]: " + plane_text(evidence.poles_zeros.poles) +
                            "\nzeros [rad/s]: " + plane_text(evidence.poles_zeros.zeros) + "\n";
  return (evidence.verdict.usable ? poles : "") +
         "residual on held-out data: " + evidence.residual.words +
         (evidence.hold.words.empty() ? "" : "\n" + evidence.hold.words) + "\n";
}

}  // namespace vibrissa::views
