#include "diagnosis/model/hypothesis.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {

const std::vector<std::string>& nuisance_ids() {
  static const std::vector<std::string> ids{"damping", "drag_error", "reference_gain",
                                            "sensor_gain", "stiffness"};
  return ids;
}

std::string joined_name(std::vector<std::string> ids) {
  if (ids.empty()) return "none";
  std::sort(ids.begin(), ids.end());
  return joined(ids, "+");
}

std::vector<std::string> effect_ids(const std::string& name) {
  std::vector<std::string> ids;
  if (name == "none") return ids;
  std::istringstream stream(name);
  for (std::string id; std::getline(stream, id, '+');) ids.push_back(id);
  return ids;
}

Hypothesis::Hypothesis(std::vector<const Effect*> effects) : effects_(std::move(effects)) {
  std::sort(effects_.begin(), effects_.end(),
            [](const Effect* a, const Effect* b) { return a->id < b->id; });
}

bool Hypothesis::contains(const std::string& id) const {
  return std::any_of(effects_.begin(), effects_.end(),
                     [&](const Effect* effect) { return effect->id == id; });
}

Hypothesis Hypothesis::discrepancy() {
  Hypothesis hypothesis;
  hypothesis.discrepancy_ = true;
  return hypothesis;
}

std::string Hypothesis::name() const {
  if (discrepancy_) return outside_catalogue;
  std::vector<std::string> ids;
  for (const Effect* effect : effects_) ids.push_back(effect->id);
  return joined_name(std::move(ids));
}

Hypothesis Hypothesis::with(const Effect& effect) const {
  std::vector<const Effect*> effects = effects_;
  effects.push_back(&effect);
  return Hypothesis(std::move(effects));
}

double log_prior_of_number(const std::size_t n, const std::size_t n_known) {
  constexpr double of_size[] = {-1.2, -0.7, -2.3, -4.6};
  double sum = n < 4 ? of_size[n] : of_size[3] - 2.3 * static_cast<double>(n - 3);
  for (std::size_t i = 0; i < n; ++i)
    sum -= std::log(static_cast<double>(n_known - i) / static_cast<double>(i + 1));
  return sum;
}

Hypothesis Hypothesis::without(const Effect& effect) const {
  std::vector<const Effect*> effects = effects_;
  std::erase(effects, &effect);
  return Hypothesis(std::move(effects));
}

}  // namespace vibrissa::diagnosis
