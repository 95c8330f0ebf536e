#include "separation/ringdown/ring_down.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "signals/base/error.h"
#include "signals/spectra/resample.h"

namespace vibrissa::separation {

namespace {

/// Damped sines one after the other.
std::vector<DecayPoint> measured_points(const RingDown& found, const DecayMoments& pieces,
                                        double rate_hz) {
  constexpr double fall = 0.5, fewest = 3., most = 12.;
  const double period = rate_hz / found.fit.law.frequency_hz;
  const double n_periods =
      std::clamp(fall / (2. * std::numbers::pi * found.largest.damping_ratio), fewest, most);
  const auto n = static_cast<std::size_t>(n_periods * period);
  std::vector<DecayPoint> out;
  for (const std::span<const double> piece : pieces)
    for (std::size_t first = 0; first + n <= piece.size(); first += n) {
      const std::span<const double> window = piece.subspan(first, n);
      const FittedDecay fit = fit_decay({.frequency_hz = found.largest.frequency_hz,
                                         .damping_ratio = found.largest.damping_ratio},
                                        {}, {&window, 1}, rate_hz);
      if (fit.covariance.size() == 0) continue;
      const FittedCurve curve{fit, 0, static_cast<double>(n) / rate_hz};
      const std::vector<DecayPoint> middle = points_of(curve, amplitudes_of(curve, 0., 1));
      if (middle.empty()) continue;
      const DecayPoint& point = middle.front();
      const bool is_told = point.frequency_hz.standard_deviation < 0.1 * fit.law.frequency_hz &&
                           point.damping_ratio.standard_deviation < point.damping_ratio.value;
      if (is_told) out.push_back(point);
    }
  std::ranges::sort(out, std::ranges::greater(), &DecayPoint::amplitude_n_m);
  return out;
}

/// Damping of the points that were measured without a law less that of the law, in standard
/// deviations (rms).
double deviation_of_rows(const RingDown& found) {
  double sum = 0.;
  for (const DecayPoint& point : found.measured) {
    const auto nearest = std::ranges::min_element(found.fitted, {}, [&](const DecayPoint& fitted) {
      return std::abs(std::log(fitted.amplitude_n_m / point.amplitude_n_m));
    });
    sum += std::pow((point.damping_ratio.value - nearest->damping_ratio.value) /
                        std::hypot(point.damping_ratio.standard_deviation,
                                   nearest->damping_ratio.standard_deviation,
                                   0.05 * nearest->damping_ratio.value),
                    2);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(found.measured.size(), 1)));
}

/// Of each piece of the moment, which lies above the centred one by its mean.
std::vector<Envelope> envelopes_of(const FittedDecay& fit, const DecayMoments& pieces,
                                   std::span<const double> centred, double mean, double rate_hz) {
  std::vector<Envelope> out;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    out.push_back(envelope_of({fit, p, static_cast<double>(pieces[p].size()) / rate_hz}));
    const double first_s = static_cast<double>(pieces[p].data() - centred.data()) / rate_hz;
    for (double& time : out.back().upper_s) time += first_s;
    for (double& time : out.back().lower_s) time += first_s;
    for (double& moment : out.back().upper_n_m) moment += mean;
    for (double& moment : out.back().lower_n_m) moment += mean;
  }
  return out;
}

/// At most so many samples are fitted, the first ones of all pieces.
void shorten(DecayMoments& pieces) {
  constexpr std::size_t most_samples = 12000, fewest_of_a_piece = 100;
  std::size_t left = most_samples;
  std::erase_if(pieces, [&](std::span<const double>& piece) {
    if (piece.size() > left && left < fewest_of_a_piece) return true;
    piece = piece.first(std::min(piece.size(), left));
    left -= piece.size();
    return false;
  });
}

std::size_t strongest_piece(const FittedDecay& fit) {
  const auto most = std::ranges::max_element(fit.starts, {}, &DecayStart::amplitude);
  return static_cast<std::size_t>(most - fit.starts.begin());
}

std::vector<std::string> laws_of(const RingDown& found) {
  constexpr double least_share = 0.05;
  const auto counts = [&](double EquivalentMode::*share) {
    return std::max(found.largest.*share, found.smallest.*share) >= least_share;
  };
  std::vector<std::string> out;
  if (counts(&EquivalentMode::viscous_share)) out.push_back("viscous");
  if (counts(&EquivalentMode::drag_share)) out.push_back("drag");
  if (counts(&EquivalentMode::friction_share)) out.push_back("friction");
  return out;
}

}  // namespace

bool RingDown::is_doubtful() const {
  constexpr double much = 2.;
  return error_rms_n_m > much * decays.noise_rms || deviation_of_rows > much;
}

RingDown identify_ring_down(std::span<const double> moment, const double sampling_rate_hz,
                            const std::string& unit) {
  constexpr std::size_t n_points = 12;
  RingDown out;
  out.unit = unit;
  out.decays = find_decays(moment, sampling_rate_hz);
  const std::vector<double> centred = signals::remove_mean(moment);
  DecayMoments pieces;
  for (const DecayPiece& piece : out.decays.pieces)
    pieces.push_back(std::span(centred).subspan(piece.first, piece.end - piece.first));
  shorten(pieces);
  GrownLaw grown = grow_law(out.decays.frequency_hz, sampling_rate_hz, pieces);
  const std::size_t piece = strongest_piece(grown.fit);
  out.fitted = points_of(grown, piece, static_cast<double>(pieces[piece].size()) / sampling_rate_hz,
                         out.decays.noise_rms, n_points);
  out.fit = std::move(grown.fit);
  if (out.fitted.empty())
    throw signals::UserError(
        "ring-down: the fit of the decay swings for less than three periods; record a longer "
        "decay");
  out.error_rms_n_m = std::sqrt(out.fit.squares / out.fit.n_samples());
  out.largest = equivalent_mode(out.fit.law, out.fitted.front().amplitude_n_m);
  out.smallest = equivalent_mode(out.fit.law, out.fitted.back().amplitude_n_m);
  out.damping_laws = laws_of(out);
  out.envelopes =
      envelopes_of(out.fit, pieces, centred, moment.front() - centred.front(), sampling_rate_hz);
  out.measured = measured_points(out, pieces, sampling_rate_hz);
  out.deviation_of_rows = deviation_of_rows(out);
  out.words = words_of(out);
  return out;
}

}  // namespace vibrissa::separation
