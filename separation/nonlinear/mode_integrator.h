#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "separation/model/rational_model.h"
#include "separation/nonlinear/input_path.h"
#include "separation/nonlinear/joint_law.h"

namespace vibrissa::separation {

/// Integrates one mode with a joint law,
///   x'' + a1 x' + a0 x + sum_k c_k f_k(x, x') = u(t),
/// from one output sample to the next by the classical Runge-Kutta rule of fourth order (Hairer,
/// Norsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed., section II.1), in equal
/// steps of at most step_rad of the mode's fastest free motion, so that frequency and damping are
/// right to about 1e-6. With sensitivities, the derivatives of the numerical solution itself with
/// respect to (a1, a0, c_1, ..., x, x' at the start) are carried along (tangents of each stage).
/// Proven by tests/separation/nonlinear/mode_integrator_test.cc.
class ModeIntegrator {
 public:
  static constexpr double step_rad = 0.1;
  static constexpr Eigen::Index most_sensitivities = 24;
  using Sensitivities = Eigen::Array<double, Eigen::Dynamic, 1, 0, most_sensitivities, 1>;

  ModeIntegrator(const ModalTerm& mode, std::span<const LawTerm> law, double sampling_rate_hz,
                 const InputPath& path, bool with_sensitivities);

  void start(double position_m, double velocity_m_s);
  void advance(const InputPath::Knots& knots);

  double position_m() const { return x_; }
  double velocity_m_s() const { return v_; }
  /// sum_k c_k f_k at the present state [m/s^2].
  double law_force() const;
  /// Derivatives of position and velocity, ordered (a1, a0, c_1, ..., start x, start x').
  const Sensitivities& position_sensitivity() const { return dx_; }
  const Sensitivities& velocity_sensitivity() const { return dv_; }
  Sensitivities law_force_sensitivity() const;

  struct Piece {
    int n_steps = 1;
    double step_s = 0.;
    InputPath::Knots start{}, end{};
  };
  /// The steps of each piece of the path.
  static std::vector<Piece> steps_of(const ModalTerm& mode, double sampling_rate_hz,
                                     const InputPath& path);

 private:
  void step(double input_start, double input_middle, double input_end, double h);
  void step_with_sensitivities(double input_start, double input_middle, double input_end, double h);
  double force(double x, double v) const;
  double rate(double x, double v, double input) const {
    return input - mode_.a0 * x - mode_.a1 * v - force(x, v);
  }
  // Rate of the velocity and, in dk, its derivatives, where x and v have the derivatives dx and dv.
  double rate(double x, double v, double input, const Sensitivities& dx, const Sensitivities& dv,
              Sensitivities& dk) const;

  ModalTerm mode_;
  std::vector<LawTerm> law_;
  std::vector<Piece> pieces_;
  bool with_sensitivities_;
  double x_ = 0., v_ = 0.;
  Sensitivities dx_, dv_;
};

}  // namespace vibrissa::separation
