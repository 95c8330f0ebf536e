#include "trial/generator/unexplained_change.h"

#include <list>
#include <numbers>

#include "signals/spectra/fft.h"
#include "trial/plant/plant.h"

namespace vibrissa::trial {
namespace {

std::vector<std::complex<double>> change_of(const signals::Record& a, const signals::Record& b,
                                            const std::string& channel) {
  const auto x = a.channel(channel), y = b.channel(channel);
  std::vector<double> difference(x.size());
  double mean = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) mean += difference[i] = y[i] - x[i];
  for (double& d : difference) d -= mean / static_cast<double>(x.size());
  return signals::real_fft(difference);
}

}  // namespace

const Structure& structure_of(const SolidChange& change) {
  static std::list<std::pair<SolidChange, Structure>> solved;
  for (const auto& [there, structure] : solved)
    if (there == change) return structure;
  solved.emplace_front(change, solve_structure(change));
  return solved.front().second;
}

UnexplainedChange::UnexplainedChange(const World& plain, const Session& session)
    : plain_(plain), bare_(session) {
  bare_.noise = false;
  std::erase_if(bare_.takes, [](const Take& take) { return take.split != signals::Split::fit; });
  const Structure& structure = structure_of(plain.solid);
  records_ = record_session(structure, plain, bare_);
  const StateSpace plant = make_plant(structure, plain);
  for (const signals::DatasetRecord& entry : records_.records) {
    const std::size_t n_samples = entry.record.n_samples();
    const double n = static_cast<double>(n_samples);
    for (std::size_t k = 1; k < n_samples / 2; ++k) {
      const std::complex<double> s(0.,
                                   2. * std::numbers::pi * static_cast<double>(k) * rate_hz / n);
      gains_.push_back(plant.response(s)(output::moment, input::acceleration));
      lengths_.push_back(n);
    }
  }
}

std::vector<std::complex<double>> UnexplainedChange::of(const World& world) const {
  const signals::Dataset with = record_session(structure_of(world.solid), world, bare_);
  std::vector<std::complex<double>> out;
  out.reserve(gains_.size());
  for (std::size_t r = 0; r < records_.records.size(); ++r) {
    const signals::Record &a = records_.records[r].record, &b = with.records[r].record;
    const auto moment = change_of(a, b, signals::channel::base_moment);
    const auto motion = change_of(a, b, signals::channel::base_acceleration);
    for (std::size_t k = 1; k < a.n_samples() / 2; ++k)
      out.push_back(moment[k] - gains_[out.size()] * motion[k]);
  }
  return out;
}

std::vector<double> UnexplainedChange::noise(const double moment, const double acceleration) const {
  std::vector<double> out(gains_.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = lengths_[i] * (moment * moment + std::norm(gains_[i]) * acceleration * acceleration);
  return out;
}

}  // namespace vibrissa::trial
