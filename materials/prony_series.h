#pragma once

#include <complex>
#include <vector>

#include "materials/isochoric_law.h"

namespace vibrissa::materials {

/// One relaxing branch: a share of the law's stress that fades with its own time.
struct PronyBranch {
  double modulus_ratio = 0.;      // g, over the modulus at infinite time
  double relaxation_time_s = 0.;  // tau
};

/// Linear viscoelasticity on any law, objective, as it lives on the second Piola-Kirchhoff stress
/// (Simo, Comput. Methods Appl. Mech. Eng. 60, 1987; T12.7):
///   S = S_law(E) + sum_i Q_i,  Q_i' + Q_i / tau_i = g_i d/dt S_law(E).
/// The law is what remains at infinite time. Proven by tests/materials/prony_series_test.cc.
class PronySeries {
 public:
  /// What a material point remembers; begins at rest.
  struct Memory {
    Stress law;                    // S_law at the last step
    std::vector<Stress> branches;  // Q_i
  };

  PronySeries() = default;
  /// Throws UserError for a ratio below zero or a time that is not above, with the branch's number.
  explicit PronySeries(std::vector<PronyBranch> branches);

  const std::vector<PronyBranch>& branches() const { return branches_; }
  Memory at_rest() const;

  /// Advances the memory by h to the strain given, and returns the stress there: exact for a law's
  /// stress that is linear in time over the step, of second order in h otherwise.
  Stress advance(const IsochoricLaw& law, const Strain& strain, double step_s,
                 Memory& memory) const;
  /// What a branch takes of a change of the law's stress over a step: g times the mean of its
  /// decay.
  static double gain(const PronyBranch& branch, double step_s);
  /// dS/dE at the end of a step, over the law's tangent there.
  double tangent_factor(double step_s) const;
  /// Modulus at a frequency over that at infinite time: 1 + sum_i g_i (i w tau_i)/(1 + i w tau_i);
  /// imaginary over real part is the loss factor.
  std::complex<double> dynamic_ratio(double frequency_rad_s) const;

 private:
  std::vector<PronyBranch> branches_;
};

}  // namespace vibrissa::materials
