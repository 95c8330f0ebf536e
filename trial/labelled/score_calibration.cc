// Calibration of the probabilities and intervals of answers: score_calibration SIMULATION N SEED. N
// sensors with effects of the catalogue have the excitation of the simulation's records, are
// measured with noise and diagnosed. Prints every trial, the share of right answers by stated
// probability, the confidence factor that calibrates the fits (diagnosis/search/calibrated_odds.h),
// and with a fourth argument, intervals, the coverage of the 95 % intervals: of the parameters of
// right answers, and of the gap closed, whose true value is computed from many further records.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <iostream>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "diagnosis/diagnosis.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/planning/planned_records.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/search/calibrated_odds.h"
#include "signals/spectra/fft.h"
#include "trial/labelled/drawn_sensor.h"
#include "trial/labelled/labelled_set.h"

namespace {

using namespace vibrissa;
using benchmarks::DrawnSensor;
using diagnosis::Complex;
using diagnosis::Experiment;
using diagnosis::PreparedRecord;
using signals::Split;
namespace channel = signals::channel;

/// The simulation's records plus one record at rest.
signals::Dataset inputs_of(const signals::Dataset& simulation) {
  signals::Dataset out = simulation;
  signals::Record still(simulation.records.front().record.sampling_rate_hz(), 2048);
  for (const std::string& name : simulation.records.front().record.channel_names())
    still.set_channel(name, std::vector<double>(still.n_samples(), 0.));
  out.records.insert(out.records.begin(), {"quiet", std::move(still), {}});
  return out;
}

struct Trial {
  double odds_against = 0.;  // odds against the best answer by the fits
  bool right = false;
  double probability(double confidence) const {
    return 1. / (1. + diagnosis::calibrated_odds(odds_against, confidence));
  }
};

double surprise(const std::vector<Trial>& trials, const double confidence) {
  double sum = 0.;
  for (const Trial& trial : trials) {
    const double p = trial.probability(confidence);
    sum -= std::log(std::max(trial.right ? p : 1. - p, 1e-12));
  }
  return sum / static_cast<double>(trials.size());
}

void print_reliability(const std::vector<Trial>& trials, const double confidence) {
  constexpr double edges[] = {0., 0.5, 0.8, 0.95, 0.99, 1.};
  double error = 0.;
  std::printf("confidence %.2f\n", confidence);
  for (std::size_t i = 0; i + 1 < std::size(edges); ++i) {
    double n = 0., right = 0., said = 0.;
    for (const Trial& trial : trials) {
      const double p = trial.probability(confidence);
      if (p <= edges[i] || p > edges[i + 1]) continue;
      n += 1.;
      right += trial.right;
      said += p;
    }
    if (n == 0.) continue;
    error += std::abs(said - right);
    std::printf("  stated %.2f..%.2f: %3.0f answers, mean %.3f, right %.3f\n", edges[i],
                edges[i + 1], n, said / n, right / n);
  }
  std::printf("  expected calibration error %.3f, mean negative log likelihood %.3f nats\n",
              error / static_cast<double>(trials.size()), surprise(trials, confidence));
}

/// Calibration of the fits, of the diagnosis, and with the best factor for these trials.
void print_calibration(const std::vector<Trial>& trials) {
  double best = 1.;
  for (double confidence = 0.05; confidence < 3.; confidence *= 1.02)
    if (surprise(trials, confidence) < surprise(trials, best)) best = confidence;
  for (const double confidence : {1., diagnosis::confidence_in_fits, best})
    print_reliability(trials, confidence);
}

/// Another record of the same kind: the same spectra with other phases.
std::vector<double> another_of_its_kind(std::span<const double> x, std::mt19937& random) {
  std::vector<Complex> spectrum = signals::real_fft(x);
  std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi);
  for (std::size_t k = 1; k < spectrum.size(); ++k) spectrum[k] *= std::polar(1., phase(random));
  signals::RealFft fft(x.size());
  std::ranges::copy(spectrum, fft.spectrum().begin());
  fft.inverse();
  return {fft.time().begin(), fft.time().end()};
}

/// Many further records of the held-out kinds.
signals::Dataset further_inputs(const signals::Dataset& inputs) {
  constexpr int n_copies = 12;
  std::mt19937 random(1);
  signals::Dataset out;
  for (const signals::DatasetRecord& entry : inputs.records) {
    if (entry.split != Split::held_out) continue;
    for (int i = 0; i < n_copies; ++i) {
      signals::DatasetRecord copy = entry;
      copy.name.append("_").append(std::to_string(i));
      for (const std::string& name : entry.record.channel_names())
        if (name != channel::base_moment)
          copy.record.set_channel(name, another_of_its_kind(entry.record.channel(name), random));
      out.records.push_back(std::move(copy));
    }
  }
  return out;
}

/// Excitation of the sensors, as datasets and prepared.
struct Inputs {
  signals::Dataset records;
  std::vector<PreparedRecord> clean;
};

Inputs prepared(const diagnosis::NominalModel& nominal, signals::Dataset records) {
  Inputs out{.records = std::move(records), .clean = {}};
  for (const Split split : {Split::fit, Split::held_out}) {
    if (std::ranges::none_of(out.records.records, [&](const auto& r) { return r.split == split; }))
      continue;
    const Experiment part = diagnosis::prepare_experiment(nominal, out.records, split,
                                                          diagnosis::InputNoise::as_measured);
    out.clean.insert(out.clean.end(), part.records.begin(), part.records.end());
  }
  return out;
}

/// Relative frequency of an event.
struct Share {
  int n = 0, yes = 0;
  void count(bool is_so) {
    ++n;
    yes += is_so;
  }
  void print(const char* what) const {
    std::printf("%s: %d of %d (%.3f)\n", what, yes, n, n == 0 ? 0. : static_cast<double>(yes) / n);
  }
};

bool holds(const std::array<double, 2>& interval, double value) {
  return interval[0] <= value && value <= interval[1];
}

struct Coverage {
  Share parameters, gap_closed;
  std::map<std::string, Share> by_parameter;
};

void count_parameters(Coverage& coverage, const DrawnSensor& sensor,
                      const std::vector<diagnosis::ParameterEstimate>& estimates) {
  for (const diagnosis::ParameterEstimate& estimate : estimates) {
    const auto& described = diagnosis::find_effect(estimate.effect).parameters;
    const auto index = std::ranges::find(described, estimate.name, &diagnosis::Parameter::name) -
                       described.begin();
    const double truth = sensor.values(estimate.effect)[static_cast<std::size_t>(index)];
    const bool held = holds(estimate.ci95, truth);
    coverage.parameters.count(held);
    coverage.by_parameter[estimate.effect + " " + estimate.name].count(held);
    if (!held)
      std::printf("      %s %s %.4g (%.4g .. %.4g), truth %.4g\n", estimate.effect.c_str(),
                  estimate.name.c_str(), estimate.value, estimate.ci95[0], estimate.ci95[1], truth);
  }
}

/// Diagnoses one sensor and counts the coverage of its intervals.
class Trials {
 public:
  Trials(const diagnosis::NominalModel& nominal, const signals::Dataset& simulation)
      : nominal_(nominal),
        bench_(prepared(nominal, inputs_of(simulation))),
        further_(prepared(nominal, further_inputs(bench_.records))),
        experiment_(diagnosis::prepare_experiment(nominal, bench_.records, Split::fit,
                                                  diagnosis::InputNoise::as_measured)),
        point_(experiment_, diagnosis::usual_noise()) {}

  /// with_intervals: also counts the coverage of the intervals.
  Trial run(unsigned seed, bool with_intervals) {
    DrawnSensor sensor(experiment_, seed);
    const signals::Dataset real =
        diagnosis::in_pieces(sensor.measure(bench_.records, bench_.clean));
    Experiment fit_records =
        diagnosis::prepare_experiment(nominal_, real, Split::fit, diagnosis::InputNoise::reduced);
    // Parameters relative to the sensor's amplitudes then have the same meaning in both.
    fit_records.scales = experiment_.scales;
    const diagnosis::SearchResult result = diagnosis::search(fit_records);
    const diagnosis::Candidate& best = result.candidates.front();
    const Trial trial{.odds_against = result.odds_against_best,
                      .right = sensor.is_answered_by(best.name, point_)};
    const diagnosis::HypothesisFit& fit = result.fits[best.fit];
    if (with_intervals && best.name == sensor.name())
      count_parameters(coverage_, sensor, diagnosis::parameter_estimates(fit, best.name));
    if (with_intervals) count_gap_closed(sensor, fit_records, held_out(real), fit);
    std::printf("%u %-6s %-40s at %.2f, shown %-40s  %-44s %.4f -> %.3f\n", seed,
                trial.right ? "right" : "wrong", sensor.name().c_str(), sensor.share(),
                sensor.shown_name(point_).c_str(), best.name.c_str(), trial.probability(1.),
                best.probability);
    std::fflush(stdout);
    return trial;
  }

  void print_coverage() const {
    coverage_.parameters.print(
        "95 % intervals of the parameters of right answers contain the truth");
    for (const auto& [name, share] : coverage_.by_parameter)
      if (share.yes < share.n) share.print(("  " + name).c_str());
    coverage_.gap_closed.print("95 % intervals of the gap closed contain that of further records");
  }

 private:
  Experiment held_out(const signals::Dataset& real) const {
    return diagnosis::prepare_experiment(nominal_, real, Split::held_out,
                                         diagnosis::InputNoise::as_measured);
  }

  void count_gap_closed(DrawnSensor& sensor, const Experiment& fitted_on,
                        const Experiment& scored_on, const diagnosis::HypothesisFit& fit) {
    const auto stated = diagnosis::score_held_out(fitted_on, scored_on, fit).overall;
    const auto truth = diagnosis::score_held_out(
                           fitted_on, held_out(sensor.measure(further_.records, further_.clean)),
                           fit, {.n_resamples = 0})
                           .overall;
    // With hardly any gap, the share of it that closes has no meaning.
    if (!stated.gap_closed_ci95 || !truth.gap_closed ||
        truth.nrmse_before < 1.1 * truth.noise_floor)
      return;
    coverage_.gap_closed.count(holds(*stated.gap_closed_ci95, *truth.gap_closed));
  }

  diagnosis::NominalModel nominal_;
  Inputs bench_, further_;
  Experiment experiment_;
  diagnosis::NominalPoint point_;
  Coverage coverage_;
};

int run(int argc, char** argv) {
  const bool with_intervals = argc == 5 && std::string(argv[4]) == "intervals";
  if (argc != 4 && !with_intervals) {
    std::cerr << "usage: score_calibration SIMULATION N SEED [intervals]\n";
    return 2;
  }
  const signals::Dataset simulation = signals::read_dataset(argv[1]);
  Trials sensors(diagnosis::identify_nominal(simulation), simulation);
  const auto first = static_cast<unsigned>(std::stoul(argv[3]));
  std::vector<Trial> trials;
  for (unsigned i = 0; i < std::stoul(argv[2]); ++i)
    trials.push_back(sensors.run(first + i, with_intervals));
  print_calibration(trials);
  if (with_intervals) sensors.print_coverage();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return benchmarks::guarded([&] { return run(argc, argv); });
}
