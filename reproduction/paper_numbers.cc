#include "reproduction/paper_numbers.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "report/text/json_file.h"
#include "reproduction/paper_figures.h"
#include "views/records/separation_scores.h"

namespace vibrissa::reproduction {

namespace {

const views::SeparatedSignal& bvrm(const PaperTrial& trial) {
  return trial.separated[0];
}
const views::SeparatedSignal& fdaf(const PaperTrial& trial) {
  return trial.separated[1];
}

std::string rounded(const double value, const int n_digits = 3) {
  return report::Cell(value).rounded(n_digits);
}

std::vector<PaperNumber> resonances(const Reproduction& r) {
  const std::string calibrated =
      "no prediction: the free length was chosen to match this value, because the geometry is "
      "unpublished";
  return {{"resonance, simulated flow sensor", "Hz", 37.32, r.sensors.flow.modes[0].frequency_hz,
           calibrated},
          {"resonance, simulated whisker sensor", "Hz", 27.20,
           r.sensors.whisker.modes[0].frequency_hz, calibrated},
          {"resonance, built flow sensor", "Hz", 31.47,
           r.experiment.identified.fit.modes[0].frequency_hz.value,
           "identified from an experiment simulated with 31.47 Hz"},
          {"damping ratio, built flow sensor", "", 0.027,
           r.experiment.identified.fit.modes[0].damping_ratio.value,
           "identified from an experiment simulated with 0.027"}};
}

std::vector<PaperNumber> fits(const Reproduction& r) {
  return {
      {"fit, simulated flow sensor", "%", 91., r.simulation.identified.held_out_fit_percent,
       "order chosen by an information criterion, with a direct term; free simulation of held-out "
       "data without noise; the paper does not state its order and its definition of fit"},
      {"fit by SRIVC, simulated flow sensor", "%", 91., r.flow_srivc_fit_percent,
       "same order from another start, by refined instrumental variables; the paper does not "
       "separate its two methods"},
      {"fit, simulated whisker sensor", "%", 87.5, r.whisker_fit_percent,
       "as for the flow sensor; the second pair of modes at 172 Hz lies in the band and requires "
       "order four"},
      {"fit by SRIVC, simulated whisker sensor", "%", 87.5, r.whisker_srivc_fit_percent,
       "as above"},
      {"fit, experiment, frequency-domain data", "%", 94.2,
       r.experiment.identified.held_out_fit_percent,
       "one mode and a direct term; limited by the noise of both channels"}};
}

std::vector<PaperNumber> separations(const Reproduction& r) {
  const std::string ratio =
      "power of the wind estimate divided by that of the vibration estimate: it depends on the "
      "levels of wind and vibration, which the paper does not state, and not on the quality of the "
      "separation";
  return {{"FDAF convergence, simulation (L = 20, mu = 0.1)", "s", 0.25,
           r.simulation.fdaf_convergence_s,
           "time until the error stays within 3 dB of its final level; the paper's value is read "
           "from a plot, and its levels and ten lines are unpublished"},
          {"vibration left by FDAF from 0.25 to 0.5 s, simulation", "dB", std::nullopt,
           r.simulation.fdaf_left_early_db,
           "level reached at the paper's 0.25 s: power of the vibration left divided by that of "
           "the vibration"},
          {"\"SNR\" of BVRM, simulation", "dB", 35.20, bvrm(r.simulation).paper_snr_db, ratio},
          {"\"SNR\" of FDAF, simulation", "dB", 34.96, fdaf(r.simulation).paper_snr_db, ratio},
          {"SDR of BVRM, simulation", "dB", std::nullopt, bvrm(r.simulation).sdr_db,
           "not in the paper: signal-to-distortion ratio against the true wind moment"},
          {"SDR of FDAF, simulation", "dB", std::nullopt, fdaf(r.simulation).sdr_db, "as above"},
          {"SDR of BVRM, experiment", "dB", std::nullopt, bvrm(r.experiment).sdr_db, "as above"},
          {"SDR of FDAF, experiment (L = 200, mu = 0.001)", "dB", std::nullopt,
           fdaf(r.experiment).sdr_db, "as above"}};
}

}  // namespace

std::vector<PaperNumber> paper_numbers(const Reproduction& r) {
  std::vector<PaperNumber> numbers = resonances(r);
  for (auto part : {fits(r), separations(r)}) {
    numbers.insert(numbers.end(), part.begin(), part.end());
  }
  numbers.push_back({"exponent of the steady moment in wind speed, 1 to 4 m/s, flow sensor", "",
                     std::nullopt, wind_exponent(r.sensors.flow, 1., 4.),
                     "the paper shows only a nonlinear curve; the exponent in acceleration is 1"});
  return numbers;
}

report::Table numbers_table(const std::vector<PaperNumber>& numbers) {
  report::Table table(
      {{"quantity", ""}, {"paper", ""}, {"Vibrissa", ""}, {"unit", ""}, {"explanation", ""}});
  for (const auto& n : numbers) {
    table.add_row({n.what, n.paper, n.ours, n.unit, n.why});
  }
  return table;
}

report::Table readings_table(const std::vector<FdafReading>& readings) {
  report::Table table({{"interpretation of L", ""},
                       {"block", ""},
                       {"filter", ""},
                       {"mu", ""},
                       {"1 / mu", "s", 3},
                       {"SDR", "dB"},
                       {"convergence", "s"},
                       {"impulse response energy cut off", "%", 3}});
  for (const auto& r : readings) {
    table.add_row({r.name, r.block_length, r.filter_length, r.step, r.learning_time_s, r.sdr_db,
                   r.convergence_s, 100. * r.missing_energy});
  }
  return table;
}

std::string explain(const std::vector<FdafReading>& readings) {
  const auto [worst, best] = std::minmax_element(
      readings.begin(), readings.end(),
      [](const FdafReading& a, const FdafReading& b) { return a.sdr_db < b.sdr_db; });
  std::string text = "Highest SDR: \"" + best->name + "\", " + rounded(best->sdr_db) +
                     " dB; lowest: \"" + worst->name + "\", " + rounded(worst->sdr_db) +
                     " dB; without separation: " + rounded(best->nothing_removed_sdr_db) + " dB. ";
  for (const auto& r : readings) {
    if (r.missing_energy > 0.01) {
      text += "\"" + r.name + "\" cuts off " + rounded(100. * r.missing_energy) +
              " % of the energy of the sensor's impulse response: its " +
              std::to_string(r.filter_length) + " taps cover only " +
              rounded(1e3 * static_cast<double>(r.filter_length) / 500.) + " ms. ";
    }
    if (!r.convergence_s) {
      text += "\"" + r.name +
              "\" has not converged after three quarters of the record: its learning time of 1 / "
              "mu blocks is " +
              rounded(r.learning_time_s) + " s. ";
    }
  }
  return text;
}

nlohmann::json reproduction_json(const Reproduction& reproduction) {
  nlohmann::json document{{"numbers", nlohmann::json::array()},
                          {"fdaf_readings", nlohmann::json::array()}};
  for (const auto& n : paper_numbers(reproduction)) {
    document["numbers"].push_back({{"what", n.what},
                                   {"unit", n.unit},
                                   {"paper", report::json_or_null(n.paper)},
                                   {"ours", report::json_or_null(n.ours)},
                                   {"why", n.why}});
  }
  for (const auto& r : reproduction.readings) {
    document["fdaf_readings"].push_back({{"name", r.name},
                                         {"block_length", r.block_length},
                                         {"filter_length", r.filter_length},
                                         {"step", r.step},
                                         {"sdr_db", r.sdr_db},
                                         {"convergence_s", report::json_or_null(r.convergence_s)},
                                         {"learning_time_s", r.learning_time_s},
                                         {"missing_energy", r.missing_energy}});
  }
  document["simulation"] = views::separation_json(reproduction.simulation.separated);
  document["experiment"] = views::separation_json(reproduction.experiment.separated);
  return document;
}

}  // namespace vibrissa::reproduction
