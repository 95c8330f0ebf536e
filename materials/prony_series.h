#pragma once

#include <complex>
#include <vector>

#include "materials/isochoric_law.h"

namespace vibrissa::materials {

/// One Prony branch: a share of the stress of the law that relaxes with its own time.
struct PronyBranch {
  double modulus_ratio = 0.;      // g, relative to the modulus at infinite time
  double relaxation_time_s = 0.;  // tau
};

/// Linear viscoelasticity for any law; objective, because it uses the second Piola-Kirchhoff stress
/// (Simo, Comput. Methods Appl. Mech. Eng. 60, 1987; T12.7):
///   S = S_law(E) + sum_i Q_i,  Q_i' + Q_i / tau_i = g_i d/dt S_law(E).
/// The law is the response at infinite time. Proven by tests/materials/prony_series_test.cc.
class PronySeries {
 public:
  /// State of a material point; starts at rest.
  struct Memory {
    Stress law;                    // S_law at the last step
    std::vector<Stress> branches;  // Q_i
  };

  PronySeries() = default;
  /// Throws UserError with the number of the branch for a ratio below zero or a time that is not
  /// above zero.
  explicit PronySeries(std::vector<PronyBranch> branches);

  const std::vector<PronyBranch>& branches() const { return branches_; }
  Memory at_rest() const;

  /// Advances the state by step_s to the given strain and returns the stress there: exact when the
  /// stress of the law is linear in time over the step, otherwise of second order in the step.
  Stress advance(const IsochoricLaw& law, const Strain& strain, double step_s,
                 Memory& memory) const;
  /// Share of a branch in a change of the stress of the law over a step: g times its mean decay.
  static double gain(const PronyBranch& branch, double step_s);
  /// dS/dE at the end of a step, divided by the tangent of the law there.
  double tangent_factor(double step_s) const;
  /// Modulus at a frequency divided by the modulus at infinite time: 1 + sum_i g_i (i w tau_i)/(1 +
  /// i w tau_i); imaginary over real part is the loss factor.
  std::complex<double> dynamic_ratio(double frequency_rad_s) const;

 private:
  std::vector<PronyBranch> branches_;
};

}  // namespace vibrissa::materials
