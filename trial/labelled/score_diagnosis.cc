// Scores diagnoses against labels: score_diagnosis SET [FIRST LAST], SET a folder with sim/,
// caseNNN/real/ and labels.json. The labels are read after the diagnosis of a case.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <set>
#include <string>

#include "diagnosis/diagnosis.h"
#include "diagnosis/model/effect.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "trial/labelled/labelled_set.h"

namespace {

namespace fs = std::filesystem;
using namespace vibrissa;
using namespace vibrissa::benchmarks;

/// Parameters of labels.json that are the same quantity as a parameter of the catalogue.
struct SameQuantity {
  const char* label;
  const char* effect;
  const char* parameter;
  double factor;  // catalogue value divided by the label's value
};
constexpr SameQuantity same_quantities[] = {
    {"delay", "delay", "tau", 1.},
    {"accel_gain", "reference_gain", "ratio", 1.},
    {"gain", "sensor_gain", "ratio", 1.},
    {"drag_scale", "drag_error", "ratio", 1.},
    {"clock_ppm", "clock_drift", "rate_error", 1e-6},
    {"hum", "hum", "amplitude", 1.},
    {"flow_lag", "flow_lag", "tau", 1.},
    {"lowpass_hz", "sensor_lowpass", "corner", 1.},
};

struct Score {
  int n = 0, right = 0, right_without_calibrations = 0, half = 0, wrong_and_sure = 0;
  int nones = 0, nones_right = 0, links_right = 0, parameters = 0, parameters_covered = 0;
  std::vector<double> gaps_closed, seconds;
};

bool shares_an_effect(const std::string& label, const std::string& verdict) {
  const std::vector<std::string> a = diagnosis::effect_ids(label),
                                 b = diagnosis::effect_ids(verdict);
  return a.size() > 1 && std::any_of(a.begin(), a.end(), [&](const std::string& id) {
           return std::find(b.begin(), b.end(), id) != b.end();
         });
}

/// Are the most probable links those of the label's effects?
bool links_are_right(const std::string& label, std::vector<std::string> links) {
  std::set<std::string> expected;
  for (const std::string& id : diagnosis::effect_ids(label))
    expected.insert(to_string(diagnosis::find_effect(id).link));
  if (links.size() > expected.size() && !expected.empty()) links.resize(expected.size());
  return std::set<std::string>(links.begin(), links.end()) == expected;
}

void score_parameters(const nlohmann::json& label, const diagnosis::RankedAnswer& answer,
                      Score& score) {
  for (const SameQuantity& same : same_quantities) {
    if (!label["parameters"].contains(same.label)) continue;
    const double truth = same.factor * label["parameters"][same.label].get<double>();
    for (const diagnosis::ParameterEstimate& estimate : answer.parameters) {
      if (estimate.effect != same.effect || estimate.name != same.parameter) continue;
      const bool covered = estimate.ci95[0] <= truth && truth <= estimate.ci95[1];
      score.parameters += 1;
      score.parameters_covered += covered;
      if (!covered)
        std::printf("       %s %s: %g (%g..%g), label %g\n", same.effect, same.parameter,
                    estimate.value, estimate.ci95[0], estimate.ci95[1], truth);
    }
  }
}

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

bool is_reducible(const std::string& label) {
  for (const std::string& id : diagnosis::effect_ids(label))
    if (diagnosis::find_effect(id).irreducible) return false;
  return true;
}

void score_case(const fs::path& set, const std::string& name,
                const diagnosis::NominalModel& nominal, Score& score) {
  const signals::Dataset real = signals::read_dataset(set / name / "real");
  const auto start = std::chrono::steady_clock::now();
  const diagnosis::Diagnosis answer = diagnosis::diagnose(nominal, real);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const nlohmann::json entry = label_of(set, name);
  const std::string label = entry["effect"];
  const bool right = answer.verdict == sorted_name(label);
  const bool nearly = without_calibrations(answer.verdict) == without_calibrations(label);
  const diagnosis::RankedAnswer& best = answer.ranking.front();
  score.n += 1;
  score.right += right;
  score.right_without_calibrations += nearly;
  score.half += !right && !nearly && shares_an_effect(label, answer.verdict);
  score.wrong_and_sure += !right && !nearly && best.probability > 0.8;
  score.nones += label == "none";
  score.nones_right += label == "none" && nearly;
  const bool links = links_are_right(label, answer.location.links);
  score.links_right += links;
  if (right || nearly) score_parameters(entry, best, score);
  const double closed = best.held_out ? best.held_out->overall.gap_closed.value_or(NAN) : NAN;
  if ((right || nearly) && label != "none" && std::isfinite(closed) && is_reducible(label))
    score.gaps_closed.push_back(closed);
  score.seconds.push_back(seconds);
  std::printf("%s %-8s %-32s %-44s %.3f  gap closed %6.3f  links %s  %5.1f s\n",
              right ? "right " : (nearly ? "nearly" : "WRONG "), name.c_str(), label.c_str(),
              answer.verdict.c_str(), best.probability, closed, links ? "right" : "WRONG", seconds);
  std::fflush(stdout);
}

void print(const Score& score) {
  std::printf(
      "%d cases: %d right, %d without calibration effects, %d more with one effect of a pair "
      "named; none: %d of %d; wrong with probability above 0.8: %d; links right: %d\n",
      score.n, score.right, score.right_without_calibrations, score.half, score.nones_right,
      score.nones, score.wrong_and_sure, score.links_right);
  const auto least = std::min_element(score.gaps_closed.begin(), score.gaps_closed.end());
  std::printf(
      "gap closed of right reducible answers: median %.3f, minimum %.3f; parameters within their "
      "interval: %d of %d; seconds: median %.1f, maximum %.1f\n",
      median(score.gaps_closed), least == score.gaps_closed.end() ? NAN : *least,
      score.parameters_covered, score.parameters, median(score.seconds),
      *std::max_element(score.seconds.begin(), score.seconds.end()));
}

int run(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::cerr << "usage: score_diagnosis SET [FIRST LAST]\n";
    return 2;
  }
  const fs::path set = argv[1];
  const std::vector<std::string> names = cases_of(set);
  const std::size_t first = argc == 4 ? std::stoul(argv[2]) : 0;
  const std::size_t end =
      argc == 4 ? std::min(names.size(), std::stoul(argv[3]) + 1) : names.size();
  const diagnosis::NominalModel nominal =
      diagnosis::identify_nominal(signals::read_dataset(set / "sim"));
  Score score;
  for (std::size_t i = first; i < end; ++i) score_case(set, names[i], nominal, score);
  print(score);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return vibrissa::benchmarks::guarded([&] { return run(argc, argv); });
}
