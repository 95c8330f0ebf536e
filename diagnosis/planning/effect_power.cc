#include "diagnosis/planning/effect_power.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "diagnosis/model/parallel.h"
#include "diagnosis/model/words.h"
#include "diagnosis/planning/projection.h"
#include "diagnosis/search/effect_size.h"

namespace vibrissa::diagnosis {
namespace {

/// Upper limit of what model form errors of linear effects explain [nats].
constexpr double most_hidden_by_form = 40.;
/// A model form error hides at most this share of the nats by which an effect is detected.
constexpr double most_share = 0.25;

/// A small change in the direction of one start.
struct FaintStart {
  Eigen::VectorXd change;
  bool of_variance = false;  // grows with the square of the share
};

struct StudiedEffect {
  const Effect* effect = nullptr;
  std::vector<EffectFamily> families{};  // one per start
  Eigen::VectorXd change{};              // at typical strength
  std::vector<FaintStart> faint{};       // one per start
  std::size_t first_column = 0;          // of faint among the directions
  EffectPower power{};
};

/// May the effect be mistaken for the alternative on a sensor of this kind?
struct OpenPair {
  std::size_t effect = 0, alternative = 0;
  SensorKind kind = SensorKind::exact;
  bool is_alike = false;
};

StudiedEffect studied(const Effect& effect) {
  StudiedEffect out{.effect = &effect};
  const std::vector<std::size_t> sized = size_parameters(effect);
  for (const std::vector<double>& start : effect.starts)
    out.families.emplace_back(effect, sized, start);
  const std::size_t first = out.families.front().parameter();
  out.power = {.effect = effect.id,
               .parameter = effect.parameters[first].name,
               .unit = effect.parameters[first].unit,
               .typical = effect.starts.front()[first]};
  return out;
}

std::string missing(const std::vector<Lack>& lacks) {
  // In the order of the enumerators.
  constexpr const char* words[] = {"base motion",
                                   "wind",
                                   "transverse acceleration",
                                   "an accelerometer that repeats samples",
                                   "a simulation with dynamics",
                                   "longer records of motion",
                                   "base motion at higher frequencies"};
  std::vector<std::string> missing;
  for (const Lack lack : lacks) missing.push_back(words[static_cast<std::size_t>(lack)]);
  return joined(missing, ", ");
}

class PowerStudy {
 public:
  PowerStudy(const Experiment& experiment, const ChannelNoise& noise, const PowerOptions& options)
      : point_(experiment, noise), options_(options) {
    for (const Effect& effect : effect_catalogue()) {
      effects_.push_back(studied(effect));
      EffectPower& power = effects_.back().power;
      power.needs = missing(lacks(experiment, effect));
      power.shown = power.needs.empty();
    }
  }

  std::vector<EffectPower> run() {
    for_each(effects_.size(), [&](std::size_t i) { find(effects_[i]); });
    std::vector<OpenPair> pairs = open_pairs();
    std::vector<bool> taking_part(effects_.size(), false);
    for (const OpenPair& pair : pairs)
      taking_part[pair.effect] = taking_part[pair.alternative] = true;
    for_each(effects_.size(), [&](std::size_t i) {
      if (taking_part[i]) set_faint(effects_[i]);
    });
    set_directions();
    for_each(pairs.size(), [&](std::size_t i) { pairs[i].is_alike = are_alike(pairs[i]); });
    for (const OpenPair& pair : pairs)
      if (pair.is_alike)
        effects_[pair.effect].power.on(pair.kind).alike.push_back(
            effects_[pair.alternative].effect->id);
    std::vector<EffectPower> out;
    for (StudiedEffect& effect : effects_) out.push_back(std::move(effect.power));
    return out;
  }

 private:
  void for_each(std::size_t n, const std::function<void(std::size_t)>& work) {
    for_each_parallel(n, options_.n_threads, work);
  }

  /// The result with fewer records; both are in the order of the catalogue.
  const EffectPower* known(const StudiedEffect& effect) const {
    if (options_.fewer_records == nullptr) return nullptr;
    return &(*options_.fewer_records)[static_cast<std::size_t>(&effect - effects_.data())];
  }

  /// Sets whether the effect is detected and, when asked for, from which size on.
  void find(StudiedEffect& effect) {
    if (effect.power.shown) {
      if (!is_settled(effect))
        effect.change = change_at(effect.families.front(), *effect.effect, 1.);
      for (const SensorKind kind : sensor_kinds) {
        Detectability& detectability = effect.power.on(kind);
        const EffectPower* before = known(effect);
        detectability.nats = before != nullptr && before->on(kind).detected
                                 ? before->on(kind).nats
                                 : nats_of(effect, effect.change, kind);
        detectability.detected = detectability.nats >= detection_threshold_nats;
        if (options_.limits) set_limit(effect, kind);
      }
    }
    const std::lock_guard lock(mutex_);
    if (options_.on_effect) options_.on_effect();
  }

  /// Detected with fewer records already, and distinguished from all effects that are shown now.
  bool is_settled(const StudiedEffect& effect) const {
    return std::ranges::all_of(sensor_kinds, [&](SensorKind kind) {
      return std::ranges::all_of(effects_, [&](const StudiedEffect& alternative) {
        return &alternative == &effect || !alternative.power.shown ||
               known_different(effect, alternative, kind);
      });
    });
  }

  Eigen::VectorXd change_at(const EffectFamily& family, const Effect& effect, double share) const {
    return point_.change(point_.x(), effect, family.values(share));
  }

  /// Parameters that are free beside the given effects.
  std::vector<std::size_t> free_parameters(SensorKind kind, const Effect* effect,
                                           const Effect* alternative = nullptr) const {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < point_.fit_parameters().size(); ++i) {
      const Effect* own = point_.fit_parameters()[i].effect;
      if (own == nullptr || (kind == SensorKind::as_built && own != effect && own != alternative))
        free.push_back(i);
    }
    return free;
  }

  double nats_of(const StudiedEffect& effect, const Eigen::VectorXd& change,
                 SensorKind kind) const {
    // The effect is too strong to be predicted.
    if (!change.allFinite()) return std::numeric_limits<double>::infinity();
    return project(point_, change, free_parameters(kind, effect.effect)).left +
           std::max(0., point_.beyond_square(change));
  }

  /// Secant steps in logarithms, because nats grow as a power of the size.
  void set_limit(StudiedEffect& effect, SensorKind kind) {
    constexpr double least_exponent = 0.5, largest_exponent = 6., near = 0.25, smallest = 1e-6;
    constexpr int n_steps = 12;
    const EffectFamily& family = effect.families.front();
    Detectability& detectability = effect.power.on(kind);
    const double low = std::log(smallest), high = std::log(family.largest_share());
    double at = 0., nats = detectability.nats, exponent = 2.;
    for (int i = 0; i < n_steps; ++i) {
      const double short_of = std::log(detection_threshold_nats / std::max(nats, 1e-12));
      if (std::abs(short_of) < near) break;
      if ((short_of > 0. && at >= high) || (short_of < 0. && at <= low)) break;
      const double move = std::isfinite(short_of) ? short_of / exponent : std::log(0.1);
      const double next =
          std::clamp(at + std::clamp(move, std::log(1e-2), std::log(30.)), low, high);
      const double there = nats_of(effect, change_at(family, *effect.effect, std::exp(next)), kind);
      if (nats > 0. && std::isfinite(nats) && std::isfinite(there) && there > 0.)
        exponent =
            std::clamp(std::log(there / nats) / (next - at), least_exponent, largest_exponent);
      at = next;
      nats = there;
    }
    detectability.detected_at_any_size = at <= low && nats > detection_threshold_nats;
    if (!detectability.detected_at_any_size && nats > 0.)
      at += std::log(detection_threshold_nats / nats) / exponent;
    if (at > high) return;
    detectability.limit = family.values(std::exp(at))[family.parameter()];
  }

  void set_faint(StudiedEffect& effect) const {
    for (const EffectFamily& family : effect.families) {
      FaintStart start{.change = change_at(family, *effect.effect, faint_share)};
      Chain chain{.structure = point_.experiment().nominal};
      effect.effect->extend(chain, family.values(faint_share), point_.experiment().scales);
      start.of_variance =
          !chain.noise.empty() || !chain.tones.empty() || chain.reference_variance > 0.;
      effect.faint.push_back(std::move(start));
    }
  }

  /// Pairs of a detected effect and an alternative that may not be distinguished from it.
  std::vector<OpenPair> open_pairs() const {
    std::vector<OpenPair> out;
    for (const SensorKind kind : sensor_kinds)
      for (std::size_t i = 0; i < effects_.size(); ++i)
        for (std::size_t j = 0; j < effects_.size(); ++j)
          if (j != i && effects_[i].power.on(kind).detected && effects_[j].power.shown &&
              !known_different(effects_[i], effects_[j], kind))
            out.push_back({i, j, kind});
    return out;
  }

  bool known_different(const StudiedEffect& effect, const StudiedEffect& alternative,
                       SensorKind kind) const {
    const EffectPower *one = known(effect), *other = known(alternative);
    return one != nullptr && other != nullptr && one->on(kind).detected && other->shown &&
           std::ranges::count(one->on(kind).alike, other->effect) == 0;
  }

  bool are_alike(const OpenPair& pair) const {
    const StudiedEffect &effect = effects_[pair.effect], &alternative = effects_[pair.alternative];
    if (!effect.change.allFinite()) return false;
    const std::vector<std::size_t> free =
        free_parameters(pair.kind, effect.effect, alternative.effect);
    // When the alternative's directions leave this much, its curvature does not explain the rest
    // either.
    constexpr double hopeless = 0.05;
    if (left_by_directions(effect, alternative, free) >
        std::max(nats_to_tell_apart, hopeless * effect.change.squaredNorm()))
      return false;
    const std::optional<Alternative> begin = nearest(effect.change, alternative);
    if (!begin) return false;
    const Projection following = project(point_, effect.change, free, begin);
    const double form = alternative.effect->model_form_error;
    const double hidden =
        std::min({most_hidden_by_form, most_share * effect.power.on(pair.kind).nats,
                  form * form * following.alternative_energy});
    return following.left < std::max(nats_to_tell_apart, hidden);
  }

  /// All parameters and all starts of the effects that take part in pairs, as directions.
  void set_directions() {
    std::vector<Eigen::VectorXd> further;
    for (StudiedEffect& effect : effects_) {
      effect.first_column = point_.columns().size() + further.size();
      for (const FaintStart& start : effect.faint) {
        further.push_back(start.change);
        if (!start.change.allFinite()) further.back().setZero();
      }
    }
    directions_ = FisherDirections(point_, further);
  }

  /// Nats of the effect's direction, at its typical energy, that remain when all directions of the
  /// alternative follow it.
  double left_by_directions(const StudiedEffect& effect, const StudiedEffect& alternative,
                            const std::vector<std::size_t>& free) const {
    std::vector<bool> chosen(static_cast<std::size_t>(directions_.columns().cols()), false);
    for (const std::size_t index : free) chosen[index] = true;
    for (std::size_t i = 0; i < alternative.faint.size(); ++i)
      chosen[alternative.first_column + i] = true;
    return directions_.left_of(static_cast<Eigen::Index>(effect.first_column),
                               effect.change.squaredNorm(), chosen);
  }

  /// The alternative at the start and size that follow the change best.
  std::optional<Alternative> nearest(const Eigen::VectorXd& change,
                                     const StudiedEffect& alternative) const {
    std::optional<Alternative> best;
    double most = 0.;
    for (std::size_t s = 0; s < alternative.faint.size(); ++s) {
      const Eigen::VectorXd& faint = alternative.faint[s].change;
      const double own = faint.squaredNorm(), factor = change.dot(faint) / own;
      if (!(own > 0.) || !(factor > 0.) || factor * factor * own <= most) continue;
      most = factor * factor * own;
      const EffectFamily& family = alternative.families[s];
      const double share =
          faint_share * (alternative.faint[s].of_variance ? std::sqrt(factor) : factor);
      best = Alternative{alternative.effect,
                         family.values(std::clamp(share, faint_share, family.largest_share()))};
    }
    return best;
  }

  NominalPoint point_;
  FisherDirections directions_;
  const PowerOptions& options_;
  std::vector<StudiedEffect> effects_;
  std::mutex mutex_;
};

}  // namespace

std::vector<EffectPower> effect_powers(const Experiment& experiment, const ChannelNoise& noise,
                                       const PowerOptions& options) {
  return PowerStudy(experiment, noise, options).run();
}

}  // namespace vibrissa::diagnosis
