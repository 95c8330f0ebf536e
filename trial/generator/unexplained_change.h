#pragma once

#include <complex>
#include <vector>

#include "trial/generator/session.h"
#include "trial/plant/structure.h"

namespace vibrissa::trial {

/// Cache of solved structures, because few worlds differ in their solid.
const Structure& structure_of(const SolidChange& change);

/// Change of the moment of a world relative to the plain world, minus the part that follows from
/// the change of the measured base motion, at the lines of the fit takes: take after take, bins 1
/// to n/2 - 1 each. Without noise; the plain sensor is measured once. Where the session has no
/// channel of the wind, the wind's moment is noise of an unknown course: it hides what it covers,
/// and its power alone tells of effects on it. Proven by
/// tests/trial/generator/detection_limit_test.cc and record_set_test.cc.
class UnexplainedChange {
 public:
  UnexplainedChange(const World& plain, const Session& session);

  const World& plain() const { return plain_; }
  /// Unscaled DFT [N m]. random: of an effect that changes variances; otherwise an unmeasured wind
  /// is off.
  std::vector<std::complex<double>> of(const World& world, bool random) const;
  /// Change of wind_power() where the wind is not measured; otherwise empty.
  std::vector<double> of_wind_power(const World& world) const;
  /// Moment of the plain sensor by the base motion alone, by the wind alone (unscaled DFT, N m). An
  /// unmeasured wind counts as none.
  std::vector<std::complex<double>> by_base() const;
  std::vector<std::complex<double>> by_wind() const;
  /// Power of the moment by a wind that nobody measures; empty where it is measured.
  const std::vector<double>& unseen_wind() const { return unseen_wind_; }
  const std::vector<double>& frequencies_hz() const { return frequencies_hz_; }
  /// Variance of each line [(N m)^2] for white noise with these standard deviations on both
  /// channels [N m, m/s^2], and for an unmeasured wind.
  std::vector<double> noise(double moment, double acceleration) const;
  /// Mean power of the wind's moment at each line [(N m)^2], smoothed over neighbouring lines; 0 in
  /// takes without wind.
  std::vector<double> wind_power(const World& world) const;

 private:
  std::vector<std::complex<double>> plain_moment(const std::vector<Take>& takes) const;

  World plain_;
  Session bare_, still_;  // fit takes without noise; the same without an unmeasured wind
  signals::Dataset records_, still_records_;
  std::vector<std::complex<double>> gains_;  // moment per base acceleration
  std::vector<double> lengths_;              // number of samples of the line's take
  std::vector<double> frequencies_hz_;
  std::vector<double> unseen_wind_;
};

}  // namespace vibrissa::trial
