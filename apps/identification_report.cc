#include "apps/identification_report.h"

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>

#include "separation/simulation.h"

namespace vibrissa::apps {

namespace {

using signals::channel::base_acceleration;
using signals::channel::base_moment;

nlohmann::json plane_json(const std::vector<separation::PlaneEstimate>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& point : points) {
    list.push_back({{"real_rad_s", point.value.real()},
                    {"imaginary_rad_s", point.value.imag()},
                    {"real_sd_rad_s", point.real_deviation},
                    {"imaginary_sd_rad_s", point.imaginary_deviation}});
  }
  return list;
}

std::string plane_text(const std::vector<separation::PlaneEstimate>& points) {
  const auto number = [](const double value) { return report::Cell(value).rounded(4); };
  std::string text;
  for (const auto& point : points) {
    text += (text.empty() ? "" : "; ") + number(point.value.real()) + " +- " +
            number(point.real_deviation);
    if (point.value.imag() != 0.) {
      text +=
          ", j(" + number(point.value.imag()) + " +- " + number(point.imaginary_deviation) + ")";
    }
  }
  return text.empty() ? "none" : text;
}

}  // namespace

nlohmann::json identification_json(const separation::Identification& identification) {
  nlohmann::json modes = nlohmann::json::array();
  for (const auto& mode : identification.fit.modes) {
    modes.push_back({{"frequency_hz", mode.frequency_hz.value},
                     {"frequency_sd_hz", mode.frequency_hz.standard_deviation},
                     {"damping_ratio", mode.damping_ratio.value},
                     {"damping_sd", mode.damping_ratio.standard_deviation},
                     {"static_gain_kg_m", mode.static_gain_kg_m.value},
                     {"static_gain_sd_kg_m", mode.static_gain_kg_m.standard_deviation}});
  }
  return {{"modes", modes},
          {"direct_term", identification.fit.direct_term_kg_m.value},
          {"direct_term_sd", identification.fit.direct_term_kg_m.standard_deviation},
          {"fit_percent", identification.held_out_fit_percent},
          {"vaf_percent", identification.held_out_vaf_percent},
          {"order", identification.order},
          {"hold", separation::to_string(identification.hold)},
          {"end", separation::to_string(identification.fit.end)}};
}

report::Table identification_table(const separation::Identification& identification) {
  report::Table table({{"mode", ""},
                       {"frequency", "Hz", 6},
                       {"+- sd", "Hz", 2},
                       {"damping ratio", ""},
                       {"+- sd", "", 2},
                       {"static gain", "kg m"},
                       {"+- sd", "kg m", 2}});
  std::size_t number = 0;
  for (const auto& mode : identification.fit.modes) {
    table.add_row({++number, mode.frequency_hz.value, mode.frequency_hz.standard_deviation,
                   mode.damping_ratio.value, mode.damping_ratio.standard_deviation,
                   mode.static_gain_kg_m.value, mode.static_gain_kg_m.standard_deviation});
  }
  return table;
}

nlohmann::json output_only_json(const separation::OutputOnlyIdentification& found) {
  nlohmann::json modes = nlohmann::json::array(), undamped = nlohmann::json::array();
  for (const auto& mode : found.modes) {
    modes.push_back({{"frequency_hz", mode.frequency_hz.value},
                     {"frequency_sd_hz", mode.frequency_hz.standard_deviation},
                     {"damping_ratio", mode.damping_ratio.value},
                     {"damping_sd", mode.damping_ratio.standard_deviation},
                     {"n_orders", mode.n_orders}});
  }
  for (const auto& line : found.undamped_hz) {
    undamped.push_back(
        {{"frequency_hz", line.value}, {"frequency_sd_hz", line.standard_deviation}});
  }
  return {{"modes", modes},
          {"undamped", undamped},
          {"n_orders", found.n_orders},
          {"words", found.words}};
}

report::Table output_only_table(const separation::OutputOnlyIdentification& found) {
  report::Table table({{"what", ""},
                       {"frequency", "Hz", 6},
                       {"+- sd", "Hz", 2},
                       {"damping ratio", ""},
                       {"+- sd", "", 2},
                       {"stands in orders", ""}});
  for (const auto& mode : found.modes) {
    table.add_row({"mode", mode.frequency_hz.value, mode.frequency_hz.standard_deviation,
                   mode.damping_ratio.value, mode.damping_ratio.standard_deviation, mode.n_orders});
  }
  for (const auto& line : found.undamped_hz) {
    table.add_row({"does not decay", line.value, line.standard_deviation, report::Cell(),
                   report::Cell(), report::Cell()});
  }
  return table;
}

ModelEvidence examine(const separation::Identification& identification,
                      const signals::Record& fitted, const signals::Record& held_out) {
  const auto& model = identification.fit.model;
  const auto input = held_out.channel(base_acceleration);
  const auto moment = held_out.channel(base_moment);
  std::vector<double> residual = separation::simulate_like(
      model, input, moment, held_out.sampling_rate_hz(), identification.hold);
  std::transform(moment.begin(), moment.end(), residual.begin(), residual.begin(), std::minus<>());
  const std::array<separation::Segment, 1> segments = {
      {{fitted.channel(base_acceleration), fitted.channel(base_moment)}}};
  separation::SrivcOptions told;
  told.hold = identification.hold;
  told.direct_term = model.direct_term_kg_m != 0.;
  return {separation::poles_and_zeros(identification.fit),
          separation::test_residual(residual, input),
          separation::check_hold(model, segments, fitted.sampling_rate_hz(), told)};
}

nlohmann::json evidence_json(const ModelEvidence& evidence) {
  return {{"poles", plane_json(evidence.poles_zeros.poles)},
          {"zeros", plane_json(evidence.poles_zeros.zeros)},
          {"residual_white", evidence.residual.whiteness.passed()},
          {"residual_independent_of_input", evidence.residual.independence.passed()},
          {"residual_words", evidence.residual.words},
          {"hold_words", evidence.hold.words}};
}

std::string evidence_text(const ModelEvidence& evidence) {
  return "poles [rad/s]: " + plane_text(evidence.poles_zeros.poles) +
         "\nzeros [rad/s]: " + plane_text(evidence.poles_zeros.zeros) +
         "\nresidual on held-out data: " + evidence.residual.words +
         (evidence.hold.words.empty() ? "" : "\n" + evidence.hold.words) + "\n";
}

}  // namespace vibrissa::apps
