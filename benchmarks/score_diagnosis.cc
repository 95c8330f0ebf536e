// Scores diagnoses against labels: score_diagnosis SET [FIRST LAST], SET a folder with sim/,
// caseNNN/real/ and labels.json. The labels are read after the diagnosis of a case is made.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "diagnosis/diagnosis.h"
#include "diagnosis/nominal_identification.h"
#include "signals/error.h"

namespace {

namespace fs = std::filesystem;
using namespace vibrissa;

/// The name without retune effects, as sensors that are a little off everywhere are scored.
std::string without_retunes(const std::string& name) {
  std::vector<std::string> ids;
  for (const std::string& id : diagnosis::effect_ids(name)) {
    const auto& retunes = diagnosis::nuisance_ids();
    if (std::find(retunes.begin(), retunes.end(), id) == retunes.end()) ids.push_back(id);
  }
  return diagnosis::joined_name(ids);
}

std::string sorted_name(const std::string& name) {
  return diagnosis::joined_name(diagnosis::effect_ids(name));
}

struct Score {
  int n = 0, right = 0, right_without_retunes = 0, wrong_and_sure = 0;
};

void score_case(const fs::path& set, const std::string& name,
                const diagnosis::NominalModel& nominal, Score& score) {
  const signals::Dataset real = signals::read_dataset(set / name / "real");
  const auto start = std::chrono::steady_clock::now();
  const diagnosis::Diagnosis answer = diagnosis::diagnose(nominal, real);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::ifstream file(set / "labels.json");
  const std::string label = nlohmann::json::parse(file)[name]["effect"];
  const bool right = answer.verdict == sorted_name(label);
  const bool nearly = without_retunes(answer.verdict) == without_retunes(label);
  const diagnosis::RankedAnswer& best = answer.ranking.front();
  score.n += 1;
  score.right += right;
  score.right_without_retunes += nearly;
  score.wrong_and_sure += !right && !nearly && best.probability > 0.8;
  const double closed = best.held_out ? best.held_out->overall.gap_closed.value_or(NAN) : NAN;
  std::printf("%s %-8s %-32s %-44s %.3f  gap closed %6.3f  %5.1f s\n",
              right ? "right " : (nearly ? "nearly" : "WRONG "), name.c_str(), label.c_str(),
              answer.verdict.c_str(), best.probability, closed, seconds);
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    std::cerr << "usage: score_diagnosis SET [FIRST LAST]\n";
    return 2;
  }
  const fs::path set = argv[1];
  const int first = argc == 4 ? std::atoi(argv[2]) : 0, last = argc == 4 ? std::atoi(argv[3]) : 999;
  const diagnosis::NominalModel nominal =
      diagnosis::identify_nominal(signals::read_dataset(set / "sim"));
  Score score;
  for (int i = first; i <= last; ++i) {
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "case%03d", i);
    if (!fs::exists(set / name.data())) break;
    score_case(set, name.data(), nominal, score);
  }
  std::printf("%d cases: %d right, %d when retunes are left out, %d wrong with more than 0.8\n",
              score.n, score.right, score.right_without_retunes, score.wrong_and_sure);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const signals::UserError& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
}
