#include "separation/nonlinear/mode_integrator.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace vibrissa::separation {

namespace {

double fastest_pole(const ModalTerm& mode) {
  const double half = 0.5 * mode.a1;
  return std::abs(half) + std::sqrt(std::abs(half * half - mode.a0));
}

}  // namespace

std::vector<ModeIntegrator::Piece> ModeIntegrator::steps_of(const ModalTerm& mode,
                                                            double sampling_rate_hz,
                                                            const InputPath& path) {
  std::vector<Piece> pieces;
  for (const InputPath::Piece& piece : path.pieces) {
    const double duration = piece.share / sampling_rate_hz;
    const double n = std::max(1., std::ceil(fastest_pole(mode) * duration / step_rad));
    pieces.push_back({static_cast<int>(n), duration / n, piece.start, piece.end});
  }
  return pieces;
}

ModeIntegrator::ModeIntegrator(const ModalTerm& mode, std::span<const LawTerm> law,
                               double sampling_rate_hz, const InputPath& path,
                               bool with_sensitivities)
    : mode_(mode),
      law_(law.begin(), law.end()),
      pieces_(steps_of(mode, sampling_rate_hz, path)),
      with_sensitivities_(with_sensitivities) {
  assert(static_cast<Eigen::Index>(law.size()) + 4 <= most_sensitivities);
  start(0., 0.);
}

void ModeIntegrator::start(double position_m, double velocity_m_s) {
  x_ = position_m;
  v_ = velocity_m_s;
  if (!with_sensitivities_) return;
  const auto n = static_cast<Eigen::Index>(law_.size()) + 4;
  dx_.setZero(n);
  dv_.setZero(n);
  dx_[n - 2] = dv_[n - 1] = 1.;
}

void ModeIntegrator::advance(const InputPath::Knots& knots) {
  for (const Piece& piece : pieces_) {
    const double first = weighted(piece.start, knots);
    const double slope = (weighted(piece.end, knots) - first) / piece.n_steps;
    for (int k = 0; k < piece.n_steps; ++k) {
      const double start = first + k * slope;
      if (with_sensitivities_)
        step_with_sensitivities(start, start + 0.5 * slope, start + slope, piece.step_s);
      else
        step(start, start + 0.5 * slope, start + slope, piece.step_s);
    }
  }
}

double ModeIntegrator::force(double x, double v) const {
  double sum = 0.;
  for (const LawTerm& term : law_) sum += term.coefficient * law_function(term, x, v).value;
  return sum;
}

double ModeIntegrator::law_force() const {
  return force(x_, v_);
}

ModeIntegrator::Sensitivities ModeIntegrator::law_force_sensitivity() const {
  Sensitivities sum = Sensitivities::Zero(dx_.size());
  for (std::size_t k = 0; k < law_.size(); ++k) {
    const LawValue f = law_function(law_[k], x_, v_);
    sum += law_[k].coefficient * (f.by_deflection * dx_ + f.by_velocity * dv_);
    sum[2 + static_cast<Eigen::Index>(k)] += f.value;
  }
  return sum;
}

void ModeIntegrator::step(double input_start, double input_middle, double input_end, double h) {
  const double k1 = rate(x_, v_, input_start);
  const double v2 = v_ + 0.5 * h * k1;
  const double k2 = rate(x_ + 0.5 * h * v_, v2, input_middle);
  const double v3 = v_ + 0.5 * h * k2;
  const double k3 = rate(x_ + 0.5 * h * v2, v3, input_middle);
  const double v4 = v_ + h * k3;
  const double k4 = rate(x_ + h * v3, v4, input_end);
  x_ += h / 6. * (v_ + 2. * (v2 + v3) + v4);
  v_ += h / 6. * (k1 + 2. * (k2 + k3) + k4);
}

double ModeIntegrator::rate(double x, double v, double input, const Sensitivities& dx,
                            const Sensitivities& dv, Sensitivities& dk) const {
  double stiffness = mode_.a0, damping = mode_.a1, sum = 0.;
  std::array<double, most_sensitivities> functions;
  for (std::size_t k = 0; k < law_.size(); ++k) {
    const LawValue f = law_function(law_[k], x, v);
    const double c = law_[k].coefficient;
    sum += c * f.value;
    stiffness += c * f.by_deflection;
    damping += c * f.by_velocity;
    functions[k] = f.value;
  }
  dk = -stiffness * dx - damping * dv;
  dk[0] -= v;
  dk[1] -= x;
  for (std::size_t k = 0; k < law_.size(); ++k)
    dk[2 + static_cast<Eigen::Index>(k)] -= functions[k];
  return input - mode_.a0 * x - mode_.a1 * v - sum;
}

void ModeIntegrator::step_with_sensitivities(double input_start, double input_middle,
                                             double input_end, double h) {
  Sensitivities dk1, dk2, dk3, dk4;
  const double k1 = rate(x_, v_, input_start, dx_, dv_, dk1);
  const double v2 = v_ + 0.5 * h * k1;
  const Sensitivities dv2 = dv_ + 0.5 * h * dk1;
  const double k2 = rate(x_ + 0.5 * h * v_, v2, input_middle, dx_ + 0.5 * h * dv_, dv2, dk2);
  const double v3 = v_ + 0.5 * h * k2;
  const Sensitivities dv3 = dv_ + 0.5 * h * dk2;
  const double k3 = rate(x_ + 0.5 * h * v2, v3, input_middle, dx_ + 0.5 * h * dv2, dv3, dk3);
  const double v4 = v_ + h * k3;
  const Sensitivities dv4 = dv_ + h * dk3;
  const double k4 = rate(x_ + h * v3, v4, input_end, dx_ + h * dv3, dv4, dk4);
  x_ += h / 6. * (v_ + 2. * (v2 + v3) + v4);
  v_ += h / 6. * (k1 + 2. * (k2 + k3) + k4);
  dx_ += h / 6. * (dv_ + 2. * (dv2 + dv3) + dv4);
  dv_ += h / 6. * (dk1 + 2. * (dk2 + dk3) + dk4);
}

}  // namespace vibrissa::separation
