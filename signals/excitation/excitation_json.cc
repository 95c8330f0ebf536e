#include <nlohmann/json.hpp>

#include "signals/excitation/excitation.h"

namespace vibrissa::signals {

namespace {

using nlohmann::json;

json line_json(const DesignedExcitation& excitation, const DescribedLine& line) {
  return {{"line", line.order},
          {"frequency_hz", line.frequency_hz},
          {"role", name_of(line.role)},
          {"amplitude", line.amplitude},
          {"reveals", revelation(excitation.design.grid, line.role)}};
}

json drive_json(const Drive& drive) {
  json result{{"level", drive.level},
              {"realisation", drive.realisation},
              {"crest_factor", drive.crest_factor}};
  if (!drive.phase_rad.empty()) result["phase_rad"] = drive.phase_rad;
  return result;
}

void add_multisine(json& document, const DesignedExcitation& excitation) {
  const ExcitationDesign& design = excitation.design;
  document["grid"] = name_of(design.grid);
  if (design.grid == LineGrid::random_odd) document["group_size"] = design.group_size;
  document["phase"] = name_of(design.phase);
  document["resolution_hz"] = excitation.resolution_hz();
  document["form"] =
      "sum over the excited lines of amplitude * cos(2 pi frequency_hz t + phase_rad); the phases "
      "are in the order of the lines; the amplitudes are those of level 1, realisation 1";
  for (const DescribedLine& line : excitation.lines)
    document["lines"].push_back(line_json(excitation, line));
}

}  // namespace

std::string name_of(ExcitationKind kind) {
  switch (kind) {
    case ExcitationKind::multisine:
      return "multisine";
    case ExcitationKind::sweep:
      return "sweep";
    case ExcitationKind::noise:
      break;
  }
  return "noise";
}

std::string name_of(PhaseRule rule) {
  switch (rule) {
    case PhaseRule::schroeder:
      return "schroeder";
    case PhaseRule::random:
      return "random";
    case PhaseRule::optimised:
      break;
  }
  return "optimised";
}

std::string name_of(SweepLaw law) {
  return law == SweepLaw::linear ? "linear" : "logarithmic";
}

json to_json(const DesignedExcitation& excitation) {
  const ExcitationDesign& design = excitation.design;
  json document{{"schema", "vibrissa-excitation-1"},
                {"kind", name_of(design.kind)},
                {"low_hz", design.low_hz},
                {"high_hz", design.high_hz},
                {"sampling_rate_hz", design.sampling_rate_hz},
                {"period_samples", design.period_samples},
                {"lead_in_periods", design.n_lead_in_periods},
                {"periods", design.n_periods},
                {"realisations", design.n_realisations},
                {"levels", design.levels},
                {"peak", design.peak},
                {"unit", design.unit},
                {"seed", design.seed},
                {"full_scale", excitation.full_scale()}};
  if (design.kind == ExcitationKind::multisine) add_multisine(document, excitation);
  if (design.kind == ExcitationKind::sweep) {
    document["sweep"] = name_of(design.sweep_law);
    document["fade_s"] = design.fade_s;
  }
  for (const Drive& drive : excitation.drives) document["drives"].push_back(drive_json(drive));
  return document;
}

}  // namespace vibrissa::signals
