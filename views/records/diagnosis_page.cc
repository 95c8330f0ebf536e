#include "views/records/diagnosis_page.h"

#include <algorithm>

#include "diagnosis/diagnosis.h"
#include "diagnosis/model/words.h"
#include "views/records/diagnosis_plots.h"

namespace vibrissa::views {
namespace {

using diagnosis::Diagnosis;
using diagnosis::percent;
using diagnosis::RankedAnswer;

std::string number(const double value) {
  return report::Cell(value).rounded(3);
}

/// "joint_friction+stiffness" as "joint friction and stiffness".
std::string in_words(const std::string& answer) {
  std::string words;
  for (const char c : answer) words += c == '_' ? " " : c == '+' ? " and " : std::string(1, c);
  return words;
}

std::string headline(const Diagnosis& d) {
  if (d.verdict == "none")
    return "No cause: noise and the usual error of a simulation explain the difference";
  if (d.verdict == diagnosis::outside_catalogue)
    return "The difference between bench and simulation has a cause that is not in the catalogue";
  std::string words = in_words(d.verdict);
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  const bool several = d.verdict.find('+') != std::string::npos;
  return words + (several ? " explain" : " explains") +
         " why the bench differs from the simulation";
}

std::string range(const double low, const double high, std::string (*text)(double)) {
  return text(low) + " to " + text(high);
}

/// What the headline means for the simulation, and findings that make it doubtful.
std::vector<std::string> verdict(const Diagnosis& d) {
  std::vector<std::string> lines;
  if (d.verdict != "none" && d.verdict != diagnosis::outside_catalogue)
    lines.push_back(diagnosis::consequence(d) + ".");
  for (const diagnosis::Finding& finding : d.findings)
    if (casts_doubt(finding.kind))
      lines.push_back("Doubtful: " + (finding.record.empty() ? "" : finding.record + ": ") +
                      finding.message);
  return lines;
}

void add_scores(std::vector<report::KeyNumber>& numbers, const diagnosis::ErrorScore& score) {
  if (score.gap_closed)
    numbers.push_back({"Gap closed", percent(*score.gap_closed),
                       score.gap_closed_ci95
                           ? "95 % interval " + range((*score.gap_closed_ci95)[0],
                                                      (*score.gap_closed_ci95)[1], percent)
                           : ""});
  numbers.push_back(
      {"Prediction error after correction", percent(score.nrmse_after),
       "before " + percent(score.nrmse_before) + ", by noise alone " + percent(score.noise_floor)});
}

std::vector<report::KeyNumber> key_numbers(const Diagnosis& d) {
  std::vector<report::KeyNumber> numbers;
  if (!d.ranking.empty()) {
    const RankedAnswer& first = d.ranking.front();
    numbers.push_back({"Probability of the answer", percent(first.probability),
                       "rest (not listed or undecided): " + percent(d.probability_of_unlisted)});
    if (first.held_out) add_scores(numbers, first.held_out->overall);
  }
  if (d.resonance)
    numbers.push_back({"Resonance, measured", number(d.resonance->measured_hz) + " Hz",
                       "simulated " + number(d.resonance->simulated_hz) +
                           " Hz; far below it the moment for the same motion is " +
                           number(d.resonance->slow_gain_ratio) + " times the simulated one"});
  if (d.wind_speed_error_m_s)
    numbers.push_back({"Wind speed error after correction",
                       number(d.wind_speed_error_m_s->after) + " m/s",
                       "before " + number(d.wind_speed_error_m_s->before) + " m/s"});
  return numbers;
}

/// Bands in which the gap is significantly larger than the noise.
report::Table band_table(const diagnosis::Location& location) {
  constexpr double significant_p = 0.01;
  report::Table table({{"record kind", ""},
                       {"from", "Hz", 3},
                       {"to", "Hz", 3},
                       {"prediction error", "% of signal", 3},
                       {"error power / noise power", "", 3},
                       {"p-value", "", 2}});
  for (const diagnosis::ChannelGap& channel : location.map)
    for (const diagnosis::BandGap& band : channel.bands)
      if (band.p_value < significant_p)
        table.add_row({channel.channel, band.low_hz, band.high_hz, 100. * band.nrmse, band.excess,
                       band.p_value});
  return table;
}

/// Parameters of the first answer and of all answers that are not improbable.
report::Table parameter_table(const Diagnosis& d) {
  report::Table table({{"answer", ""},
                       {"effect", ""},
                       {"parameter", ""},
                       {"value", "", 3},
                       {"95 % from", "", 3},
                       {"95 % to", "", 3},
                       {"unit", ""},
                       {"at limit of range", ""}});
  constexpr double improbable = 0.01;
  for (const RankedAnswer& answer : d.ranking) {
    if (answer.probability < improbable && &answer != &d.ranking.front()) continue;
    for (const auto* estimates : {&answer.parameters, &answer.materials})
      for (const diagnosis::ParameterEstimate& p : *estimates)
        table.add_row({answer.name, p.effect, p.name, p.value, p.ci95[0], p.ci95[1],
                       p.relative_to.empty() ? p.unit : p.relative_to, p.at_limit ? "yes" : ""});
  }
  return table;
}

report::Table attribution_table(const diagnosis::Attribution& attribution) {
  report::Table table({{"change", ""},
                       {"kind", ""},
                       {"share alone", "%", 3},
                       {"share in company", "%", 3},
                       {"returns without it", "%", 3},
                       {"95 % from", "%", 3},
                       {"to", "%", 3}});
  for (const diagnosis::AttributedChange& change : attribution.changes) {
    const auto& ci = change.share_ci95;
    table.add_row({change.id, change.calibration ? "calibration" : "effect", 100. * change.alone,
                   100. * change.share, 100. * change.missed,
                   ci ? report::Cell(100. * (*ci)[0]) : report::Cell(),
                   ci ? report::Cell(100. * (*ci)[1]) : report::Cell()});
  }
  if (!attribution.changes.empty())
    table.add_row({"unexplained", "", report::Cell(), 100. * attribution.unexplained,
                   report::Cell(), report::Cell(), report::Cell()});
  return table;
}

void add_score_row(report::Table& table, const std::string& name,
                   const diagnosis::ErrorScore& score) {
  const auto in_percent = [](const std::optional<double>& share) {
    return share ? report::Cell(100. * *share) : report::Cell();
  };
  const auto& ci = score.gap_closed_ci95;
  table.add_row({name, 100. * score.nrmse_before, 100. * score.nrmse_after,
                 100. * score.noise_floor, in_percent(score.gap_closed),
                 ci ? report::Cell(100. * (*ci)[0]) : report::Cell(),
                 ci ? report::Cell(100. * (*ci)[1]) : report::Cell()});
}

report::Table held_out_table(const diagnosis::HeldOutScore& score) {
  report::Table table({{"record", ""},
                       {"prediction error before", "%", 3},
                       {"after correction", "%", 3},
                       {"noise floor", "%", 3},
                       {"gap closed", "%", 4},
                       {"95 % from", "%", 4},
                       {"95 % to", "%", 4}});
  add_score_row(table, "all records", score.overall);
  for (const diagnosis::ErrorScore& record : score.records)
    add_score_row(table, record.record, record);
  return table;
}

report::Table finding_table(const Diagnosis& d) {
  report::Table table({{"record", ""}, {"finding", ""}});
  for (const diagnosis::Finding& finding : d.findings)
    table.add_row({finding.record.empty() ? "all" : finding.record, finding.message});
  for (const std::string& guess : d.guesses) table.add_row({"all", "assumed: " + guess});
  return table;
}

report::Table untested_table(const Diagnosis& d) {
  report::Table table({{"effect", ""}, {"reason", ""}});
  for (const diagnosis::UntestedEffect& entry : d.untested)
    table.add_row({entry.effect, entry.reason});
  return table;
}

void add(report::PageSection& section, const std::string& name, const std::string& caption,
         report::Table table) {
  if (table.n_rows() > 0) section.tables.push_back({name, caption, std::move(table)});
}

void add_figure(report::PageSection& section, const std::vector<report::Figure>& figures,
                const std::string& name) {
  for (const report::Figure& figure : figures)
    if (figure.name == name) section.figures.push_back(figure);
}

report::PageSection where(const Diagnosis& d, const std::vector<report::Figure>& figures) {
  report::PageSection section{.heading = "Where", .text = {location_sentence(d.location)}};
  if (!d.location.links.empty())
    section.text.push_back("Probable location in the measuring chain: " +
                           diagnosis::joined(d.location.links, ", ") + ".");
  add(section, "bands", "Bands in which the gap is significantly larger than the noise",
      band_table(d.location));
  for (report::PageTable& table : section.tables) table.folded = true;
  add_figure(section, figures, "gap_map");
  return section;
}

report::PageSection cause(const Diagnosis& d, const std::vector<report::Figure>& figures) {
  report::PageSection section{.heading = "Cause"};
  if (d.nearest_known)
    section.text.push_back("Nearest known answer: " + in_words(d.nearest_known->name) +
                           "; an unknown cause explains the records better.");
  for (const auto& set : d.indistinguishable)
    section.text.push_back("These records cannot separate: " + diagnosis::joined(set, ", ") + ".");
  if (d.unknown_cause)
    section.text.push_back("Unknown part: " + diagnosis::unknown_sentence(d) + ".");
  add_figure(section, figures, "unknown_part");
  add(section, "ranking", "Answers, the most probable first", ranking_table(d));
  add(section, "parameters", "Parameters of the answers", parameter_table(d));
  add(section, "attribution", "Share of the gap that each change of the simulation closes",
      attribution_table(d.attribution));
  add_figure(section, figures, "ranking");
  return section;
}

std::string separation_sentence(const Diagnosis& d) {
  std::string text;
  if (!d.ranking.empty() && d.ranking.front().held_out &&
      d.ranking.front().held_out->vibration_left_db) {
    const auto& left = *d.ranking.front().held_out->vibration_left_db;
    text +=
        "Vibration left after subtracting the prediction: " + diagnosis::one_decimal(left.before) +
        " dB before, " + diagnosis::one_decimal(left.after) + " dB after correction. ";
  }
  if (d.separation_sdr_db)
    text += "Signal-to-distortion ratio of the wind moment: " +
            diagnosis::one_decimal(d.separation_sdr_db->before) + " dB before, " +
            diagnosis::one_decimal(d.separation_sdr_db->after) + " dB after correction.";
  return text;
}

report::PageSection improvement(const Diagnosis& d, const std::vector<report::Figure>& figures) {
  report::PageSection section{
      .heading = "Improvement",
      .text = {"Prediction errors on held-out records, which were not used for the fit: rms error "
               "divided by the rms of the measured moment."}};
  if (const std::string text = separation_sentence(d); !text.empty()) section.text.push_back(text);
  if (!d.ranking.empty() && d.ranking.front().held_out)
    add(section, "held_out", "Held-out records, corrected by the first answer",
        held_out_table(*d.ranking.front().held_out));
  add_figure(section, figures, "response");
  if (!d.levels.empty())
    add(section, "peaks", "Peaks of the responses by level", level_table(d.levels));
  if (!d.trace.time_s.empty()) section.figures.push_back(held_out_record_figure(d));
  return section;
}

report::PageSection next_section(const Diagnosis& d) {
  report::PageSection section{.heading = "Next experiment"};
  if (d.next.name == "none")
    section.text.push_back("No further measurement is needed: " + d.next.why + ".");
  else
    section.text.push_back("Measure " + in_words(d.next.name) + ": " + d.next.why +
                           ". Probability that it distinguishes two remaining answers: " +
                           percent(d.next.split_probability) + ".");
  if (!d.next.would_separate.empty())
    section.text.push_back("It distinguishes " + diagnosis::joined(d.next.would_separate, ", ") +
                           ".");
  add(section, "untested", "Not tested by these records", untested_table(d));
  add(section, "findings", "Findings about the data", finding_table(d));
  return section;
}

report::Table explanation_table(const diagnosis::ResonanceDiagnosis& d) {
  report::Table table({{"explanation", ""},
                       {"odds", "%", 2},
                       {"value needed", ""},
                       {"within the usual range", ""},
                       {"remaining damping ratio", "", 3}});
  for (const diagnosis::ResonanceExplanation& explanation : d.explanations) {
    std::vector<std::string> needed;
    for (const diagnosis::NeededValue& value : explanation.parameters)
      needed.push_back(value.effect + " " + value.name + " " + number(value.value) +
                       (value.unit == "1" ? "" : " " + value.unit) + " (usual " +
                       range(value.usual_low, value.usual_high, number) + ")");
    table.add_row({explanation.name(), 100. * explanation.odds,
                   explanation.possible ? diagnosis::joined(needed, "; ") : "impossible",
                   explanation.inside_usual_range ? "yes" : "no", explanation.damping_left});
  }
  return table;
}

}  // namespace

report::Page diagnosis_page(const Diagnosis& d) {
  const std::vector<report::Figure> figures = diagnosis_plots(d);
  return {
      .title = "Why the bench differs from the simulation",
      .headline = headline(d),
      .verdict = verdict(d),
      .numbers = key_numbers(d),
      .sections = {where(d, figures), cause(d, figures), improvement(d, figures), next_section(d)}};
}

report::Page resonance_gap_page(const diagnosis::ResonanceDiagnosis& d) {
  const std::string simulated = number(d.simulated.frequency_hz) + " Hz",
                    measured = number(d.measured.frequency_hz) + " Hz";
  report::PageSection what{.heading = "Possible causes",
                           .text = {"Two resonance frequencies alone do not decide. The odds "
                                    "follow from the usual ranges of the parameters."}};
  add(what, "explanations", "Explanations, the most probable first", explanation_table(d));
  report::PageSection next{.heading = "Next experiment"};
  next.text.push_back("Measure " + in_words(d.next.name) + ": " + d.next.why + ".");
  return {
      .title = "Possible causes of the difference between two resonances",
      .headline = "Most probable: " + in_words(d.verdict),
      .verdict = {"The simulation resonates at " + simulated + ", the sensor at " + measured + "."},
      .numbers = {{"Stiffness/mass ratio, measured / simulated", number(d.modal_ratio), ""}},
      .sections = {std::move(what), std::move(next)}};
}

}  // namespace vibrissa::views
