#include "trial/generator/unexplained_change.h"

#include <algorithm>
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

/// Mean over the line and its neighbours up to this distance.
std::vector<double> smoothed(const std::vector<double>& power) {
  constexpr std::ptrdiff_t reach = 8;
  const auto n = static_cast<std::ptrdiff_t>(power.size());
  std::vector<double> out(power.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, i - reach),
                         end = std::min(n, i + reach + 1);
    double sum = 0.;
    for (std::ptrdiff_t k = first; k < end; ++k) sum += power[static_cast<std::size_t>(k)];
    out[static_cast<std::size_t>(i)] = sum / static_cast<double>(end - first);
  }
  return out;
}

/// Unscaled DFT of the moment, bins 1 to n/2 - 1.
std::vector<std::complex<double>> moment_lines(const signals::Record& record) {
  const auto moment = record.channel(signals::channel::base_moment);
  const std::vector<std::complex<double>> lines =
      signals::real_fft(std::vector<double>(moment.begin(), moment.end()));
  return {lines.begin() + 1, lines.begin() + static_cast<std::ptrdiff_t>(record.n_samples() / 2)};
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
  still_ = bare_;
  if (!session.has_wind_channel)
    for (Take& take : still_.takes) take.wind_mean = 0.;
  still_records_ = session.has_wind_channel ? records_ : record_session(structure, plain, still_);
  const StateSpace plant = make_plant(structure, plain);
  for (const signals::DatasetRecord& entry : records_.records) {
    const std::size_t n_samples = entry.record.n_samples();
    const double n = static_cast<double>(n_samples);
    for (std::size_t k = 1; k < n_samples / 2; ++k) {
      frequencies_hz_.push_back(static_cast<double>(k) * rate_hz / n);
      const std::complex<double> s(0., 2. * std::numbers::pi * frequencies_hz_.back());
      gains_.push_back(plant.response(s)(output::moment, input::acceleration));
      lengths_.push_back(n);
    }
  }
  if (!session.has_wind_channel) unseen_wind_ = wind_power(plain);
}

std::vector<double> UnexplainedChange::wind_power(const World& world) const {
  Session at_rest = bare_;
  for (Take& take : at_rest.takes) take.base_rms = 0.;
  std::vector<double> out;
  for (const signals::DatasetRecord& entry :
       record_session(structure_of(world.solid), world, at_rest).records) {
    std::vector<double> power;
    for (const std::complex<double>& line : moment_lines(entry.record))
      power.push_back(std::norm(line));
    const std::vector<double> lines = smoothed(power);
    out.insert(out.end(), lines.begin(), lines.end());
  }
  return out;
}

std::vector<double> UnexplainedChange::of_wind_power(const World& world) const {
  if (unseen_wind_.empty()) return {};
  std::vector<double> out = wind_power(world);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= unseen_wind_[i];
  return out;
}

std::vector<std::complex<double>> UnexplainedChange::of(const World& world,
                                                        const bool random) const {
  const signals::Dataset& plain = random ? records_ : still_records_;
  const signals::Dataset with =
      record_session(structure_of(world.solid), world, random ? bare_ : still_);
  std::vector<std::complex<double>> out;
  out.reserve(gains_.size());
  for (std::size_t r = 0; r < plain.records.size(); ++r) {
    const signals::Record &a = plain.records[r].record, &b = with.records[r].record;
    const auto moment = change_of(a, b, signals::channel::base_moment);
    const auto motion = change_of(a, b, signals::channel::base_acceleration);
    for (std::size_t k = 1; k < a.n_samples() / 2; ++k)
      out.push_back(moment[k] - gains_[out.size()] * motion[k]);
  }
  return out;
}

std::vector<std::complex<double>> UnexplainedChange::plain_moment(
    const std::vector<Take>& takes) const {
  Session session = still_;
  session.takes = takes;
  std::vector<std::complex<double>> out;
  for (const signals::DatasetRecord& entry :
       record_session(structure_of(plain_.solid), plain_, session).records) {
    const std::vector<std::complex<double>> lines = moment_lines(entry.record);
    out.insert(out.end(), lines.begin(), lines.end());
  }
  return out;
}

std::vector<std::complex<double>> UnexplainedChange::by_base() const {
  std::vector<Take> takes = still_.takes;
  for (Take& take : takes) take.wind_mean = 0.;
  return plain_moment(takes);
}

std::vector<std::complex<double>> UnexplainedChange::by_wind() const {
  std::vector<Take> takes = still_.takes;
  for (Take& take : takes) take.base_rms = 0.;
  return plain_moment(takes);
}

std::vector<double> UnexplainedChange::noise(const double moment, const double acceleration) const {
  std::vector<double> out(gains_.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = lengths_[i] * (moment * moment + std::norm(gains_[i]) * acceleration * acceleration) +
             (unseen_wind_.empty() ? 0. : unseen_wind_[i]);
  return out;
}

}  // namespace vibrissa::trial
