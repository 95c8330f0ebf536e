#include "views/records/nonlinear_report.h"

#include "report/figures/table.h"
#include "views/records/identification_report.h"

namespace vibrissa::views {

namespace {

report::Table law_table(const separation::FittedNonlinearBvrm& fit) {
  report::Table table({{"term", ""}, {"coefficient", ""}, {"± sd", "", 2}, {"unit", ""}});
  for (std::size_t k = 0; k < fit.model.law.size(); ++k)
    table.add_row({fit.model.law[k].name(), fit.model.law[k].coefficient,
                   fit.coefficient_deviation(k), fit.model.law[k].unit()});
  return table;
}

report::Table trial_table(const std::vector<separation::LawTrial>& trials) {
  report::Table table({{"tried", ""},
                       {"channel shows", ""},
                       {"unseen rms", "N m", 4},
                       {"gain in sd", "", 3},
                       {"taken", ""}});
  for (const auto& trial : trials)
    table.add_row({trial.term, trial.readout, trial.unseen_rms_n_m, trial.gain_deviations,
                   trial.accepted ? "yes" : "no"});
  return table;
}

separation::FittedBvrm linear_part(const separation::FittedNonlinearBvrm& fit) {
  const auto n = separation::n_parameters(fit.model.linear.modes.size(), true);
  return separation::make_fitted(separation::to_parameters(fit.model.linear, true),
                                 fit.covariance.topLeftCorner(n, n), true,
                                 fit.model.linear.delay_s);
}

}  // namespace

std::string nonlinear_text(const separation::NonlinearIdentification& found) {
  const auto number = [](const double value) { return report::Cell(value).rounded(4); };
  const separation::FittedBvrm linear = linear_part(found.fit);
  std::string text = found.words + "\n" + identification_table(linear).to_text();
  if (found.has_law()) text += law_table(found.fit).to_text();
  text += "direct term " + number(linear.direct_term_kg_m.value) + " kg m; " +
          to_string(found.fit.model.hold_or({})) + " input, " + to_string(found.fit.end) +
          "\nrms error on held-out data, free simulation: " + number(found.held_out_rms_n_m) +
          " N m, of the linear model " + number(found.linear_held_out_rms_n_m) + " N m; fit " +
          number(found.held_out_fit_percent) + " %\n" + trial_table(found.choice.trials).to_text();
  return text;
}

}  // namespace vibrissa::views
