// Scores baseline methods against labels: score_baselines SET. Five methods name a cause with the
// same simulator of the measuring chain and the same records as `vibrissa diagnose`:
//   correlation   the effect whose shape the residual of the simulation resembles most
//   k, c, m       sensitivity updating of stiffness, damping and mass alone, by BIC
//   discrepancy   a flexible discrepancy without physics, against nothing
//   lasso         sparse regression of the residual on the shapes of all effects, by BIC
//   BIC           every single effect fitted, the least BIC
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>

#include "diagnosis/fit/hypothesis_fit.h"
#include "diagnosis/localisation/location.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "trial/labelled/labelled_set.h"

namespace {

namespace fs = std::filesystem;
using namespace vibrissa;
using namespace vibrissa::diagnosis;
using namespace vibrissa::benchmarks;

/// Residual of the simulation, and the shapes of effects at their starts, whitened by the standard
/// deviations of the fit without effects; real and imaginary parts in turn.
struct Shapes {
  Eigen::VectorXd residual;
  std::vector<std::string> ids;  // one per column
  Eigen::MatrixXd columns;
};

Eigen::VectorXd whitened(const std::vector<std::vector<Complex>>& values,
                         const std::vector<WhitenedRecord>& scale) {
  std::vector<double> out;
  for (std::size_t r = 0; r < values.size(); ++r)
    for (std::size_t b = 0; b < values[r].size(); ++b) {
      out.push_back(values[r][b].real() / scale[r].deviation[b]);
      out.push_back(values[r][b].imag() / scale[r].deviation[b]);
    }
  return Eigen::Map<Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

Shapes shapes_of(const Experiment& experiment, const HypothesisFit& none) {
  const std::vector<WhitenedRecord> scale = whitened_residual(experiment, none);
  const Chain nominal{.structure = experiment.nominal,
                      .joint_share = experiment.nominal.joint_share};
  const auto means = ChainSimulator(nominal).means(experiment.records);
  std::vector<std::vector<Complex>> measured;
  for (const PreparedRecord& record : experiment.records) measured.push_back(record.moment);
  Shapes shapes;
  const Eigen::VectorXd mean = whitened(means, scale);
  shapes.residual = whitened(measured, scale) - mean;
  std::vector<Eigen::VectorXd> columns;
  for (const Effect& effect : effect_catalogue()) {
    if (!shows(experiment, effect)) continue;
    for (const std::vector<double>& start : effect.starts) {
      Chain chain = nominal;
      effect.extend(chain, start, experiment.scales);
      const Eigen::VectorXd change =
          whitened(ChainSimulator(chain).means(experiment.records), scale) - mean;
      if (!(change.norm() > 0.) || !change.allFinite()) continue;
      columns.push_back(change / change.norm());
      shapes.ids.push_back(effect.id);
    }
  }
  shapes.columns.resize(mean.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    shapes.columns.col(static_cast<Eigen::Index>(i)) = columns[i];
  return shapes;
}

std::string by_correlation(const Shapes& shapes) {
  Eigen::Index best = 0;
  (shapes.columns.transpose() * shapes.residual).cwiseAbs().maxCoeff(&best);
  return shapes.ids[static_cast<std::size_t>(best)];
}

double bic(double log_likelihood, std::size_t n_parameters, std::size_t n_bins) {
  return -2. * log_likelihood +
         static_cast<double>(n_parameters) * std::log(static_cast<double>(n_bins));
}

/// Lasso by coordinate descent along a path of penalties; returns the point with the least BIC.
std::string by_lasso(const Shapes& shapes) {
  const Eigen::MatrixXd gram = shapes.columns.transpose() * shapes.columns;
  const Eigen::VectorXd overlap = shapes.columns.transpose() * shapes.residual;
  const double energy = shapes.residual.squaredNorm();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(overlap.size());
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::string> chosen;
  double penalty = overlap.cwiseAbs().maxCoeff();
  for (int step = 0; step < 40; ++step, penalty *= 0.8) {
    for (int sweep = 0; sweep < 200; ++sweep) {
      double moved = 0.;
      for (Eigen::Index i = 0; i < weights.size(); ++i) {
        const double rest = overlap(i) - gram.row(i).dot(weights) + gram(i, i) * weights(i);
        const double next =
            std::copysign(std::max(0., std::abs(rest) - penalty), rest) / gram(i, i);
        moved = std::max(moved, std::abs(next - weights(i)));
        weights(i) = next;
      }
      if (moved < 1e-4 * penalty) break;
    }
    const double left = energy - 2. * overlap.dot(weights) + weights.dot(gram * weights);
    const auto n = static_cast<std::size_t>((weights.array() != 0.).count());
    const double score = bic(-left, n, static_cast<std::size_t>(shapes.residual.size()));
    if (score >= least) continue;
    least = score;
    chosen.clear();
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const std::string& id = shapes.ids[static_cast<std::size_t>(i)];
      if (weights(i) != 0. && std::find(chosen.begin(), chosen.end(), id) == chosen.end())
        chosen.push_back(id);
    }
  }
  return joined_name(chosen);
}

std::size_t n_bins(const Experiment& experiment) {
  std::size_t sum = 0;
  for (const PreparedRecord& record : experiment.records) sum += record.n_bins();
  return sum;
}

/// The hypothesis with the least BIC.
std::string by_bic(const Experiment& experiment, const HypothesisFit& none,
                   const std::vector<std::vector<std::string>>& hypotheses) {
  double least = bic(none.log_likelihood, none.fit_parameters.size(), n_bins(experiment));
  std::string name = "none";
  for (const std::vector<std::string>& ids : hypotheses) {
    std::vector<const Effect*> effects;
    for (const std::string& id : ids) effects.push_back(&find_effect(id));
    const HypothesisFit fit = fit_hypothesis(experiment, Hypothesis(effects));
    const double score = bic(fit.log_likelihood, fit.fit_parameters.size(), n_bins(experiment));
    if (!(score < least)) continue;
    least = score;
    name = joined_name(ids);
  }
  return name;
}

std::vector<std::string> answers(const Experiment& experiment) {
  const HypothesisFit none = fit_hypothesis(experiment, Hypothesis{});
  const bool has_gap = locate_gap(experiment).p_value < 0.01;
  const Shapes shapes = shapes_of(experiment, none);
  const HypothesisFit discrepancy = fit_hypothesis(experiment, Hypothesis::discrepancy(), &none);
  std::vector<std::vector<std::string>> singles;
  for (const Effect& effect : effect_catalogue())
    if (shows(experiment, effect)) singles.push_back({effect.id});
  return {has_gap ? by_correlation(shapes) : "none",
          by_bic(experiment, none,
                 {{"stiffness"},
                  {"damping"},
                  {"mass"},
                  {"damping", "stiffness"},
                  {"damping", "mass"},
                  {"mass", "stiffness"},
                  {"damping", "mass", "stiffness"}}),
          discrepancy.log_evidence > none.log_evidence ? outside_catalogue : "none",
          by_lasso(shapes), by_bic(experiment, none, singles)};
}

int run(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: score_baselines SET\n";
    return 2;
  }
  const fs::path set = argv[1];
  const NominalModel nominal = identify_nominal(signals::read_dataset(set / "sim"));
  const std::vector<std::string> names{"correlation", "k, c, m", "discrepancy", "lasso", "BIC"};
  std::vector<int> right(names.size(), 0), nearly(names.size(), 0);
  int n = 0;
  for (const std::string& name : cases_of(set)) {
    const Experiment experiment =
        prepare_experiment(nominal, signals::read_dataset(set / name / "real"), signals::Split::fit,
                           InputNoise::reduced);
    const std::vector<std::string> given = answers(experiment);
    const std::string label = sorted_name(label_of(set, name)["effect"]);
    ++n;
    std::printf("%s %-30s", name.c_str(), label.c_str());
    for (std::size_t i = 0; i < names.size(); ++i) {
      right[i] += given[i] == label;
      nearly[i] += without_calibrations(given[i]) == without_calibrations(label);
      std::printf(" | %s", given[i].c_str());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    std::printf("%-12s %d of %d right, %d when calibrations are left out\n", names[i].c_str(),
                right[i], n, nearly[i]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return vibrissa::benchmarks::guarded([&] { return run(argc, argv); });
}
