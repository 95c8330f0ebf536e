#include "diagnosis/steady_state/harmonic_balance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "diagnosis/response/difference_integrator.h"

namespace vibrissa::diagnosis {
namespace {

using signals::n_lanes;

const JointModel& known(const std::optional<JointModel>& joint) {
  assert(joint && "a steady state with joint laws needs a mode");
  return *joint;
}

std::vector<std::unique_ptr<JointLaw>> laws_of(const Chain& chain, const std::size_t number) {
  std::vector<std::unique_ptr<JointLaw>> laws;
  for (const JointLawMaker& maker : chain.joint)
    laws.push_back(maker(Lanes::Constant(static_cast<double>(number))));
  return laws;
}

bool any_memory(const Chain& chain) {
  const auto laws = laws_of(chain, 0);
  return std::any_of(laws.begin(), laws.end(), [](const auto& law) { return law->has_memory(); });
}

Complex order_of(const Eigen::VectorXd& coordinates, const Eigen::Index i) {
  return {coordinates(2 * i), coordinates(2 * i + 1)};
}

Complex order_of(const LaneRows& coordinates, const Eigen::Index i, const Eigen::Index lane) {
  return {coordinates(2 * i, lane), coordinates(2 * i + 1, lane)};
}

void set_order(Eigen::VectorXd& coordinates, const Eigen::Index i, const Complex value) {
  coordinates(2 * i) = value.real();
  coordinates(2 * i + 1) = value.imag();
}

LaneRows same_in_all_lanes(const Eigen::VectorXd& y) {
  return y.array().replicate<1, n_lanes>();
}

/// A response takes thousands of balances with few different bases.
const FourierBasis& known_basis(const std::size_t highest, const bool only_odd) {
  thread_local std::map<std::pair<std::size_t, bool>, FourierBasis> bases;
  return bases.try_emplace({highest, only_odd}, highest, only_odd).first->second;
}

/// The motions in their own lanes; the last one also in those that are left.
struct InLanes {
  LaneRows y;
  Lanes w, earlier_peak;
};
InLanes in_lanes(std::span<const PeriodicMotion> motions) {
  assert(!motions.empty() && motions.size() <= static_cast<std::size_t>(n_lanes));
  InLanes out{.y = LaneRows(motions.front().y.size(), n_lanes), .w = {}, .earlier_peak = {}};
  for (Eigen::Index lane = 0; lane < n_lanes; ++lane) {
    const PeriodicMotion& motion =
        motions[std::min(static_cast<std::size_t>(lane), motions.size() - 1)];
    out.y.col(lane) = motion.y.array();
    out.w(lane) = motion.w_rad_s;
    out.earlier_peak(lane) = motion.earlier_peak;
  }
  return out;
}

}  // namespace

HarmonicBalance::HarmonicBalance(const Chain& chain, const HarmonicDrive& drive,
                                 const std::size_t highest_order)
    : chain_(chain),
      drive_(drive),
      response_(chain),
      joint_(known(response_.joint()).dynamic()),
      basis_(known_basis(highest_order, drive.wind_speed_m_s.value_or(0.) == 0.)),
      has_memory_(any_memory(chain)) {
  if (!drive.wind_speed_m_s) return;
  wind_gain_ = chain.structure.modes.front().wind_gain * chain.drag_factor;
  if (*drive.wind_speed_m_s == 0.) return;
  const LinearPart still = response_.at(0., drive.readout);
  const double force = chain.drag_factor * chain.structure.drag_curve.drag(*drive.wind_speed_m_s);
  steady_moment_ = still.wind.real() * force;
  steady_elastic_ = (still.elastic * still.wind).real() * force;
}

HarmonicBalance::Coefficients HarmonicBalance::coefficients(const double w_rad_s,
                                                            const double drive_share) const {
  Coefficients out;
  out.linear = linear_motion(w_rad_s, drive_share);
  for (const std::size_t order : basis_.orders()) {
    const auto elastic = joint_.elastic_response(Complex(0., static_cast<double>(order) * w_rad_s));
    out.torque.push_back(elastic.torque);
    out.external.push_back(elastic.external);
  }
  return out;
}

Eigen::VectorXd HarmonicBalance::linear_motion(const double w_rad_s,
                                               const double drive_share) const {
  return linear_motion(w_rad_s, drive_share, response_.at(Complex(0., w_rad_s), drive_.readout));
}

Eigen::VectorXd HarmonicBalance::linear_motion(const double w_rad_s, const double drive_share,
                                               const LinearPart& part) const {
  const Complex y = drive_share * drive_.acceleration_at(w_rad_s) * part.base * part.elastic;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(basis_.n_coordinates());
  set_order(out, basis_.fundamental() / 2, y);
  if (!basis_.only_odd()) out(0) = steady_elastic_;
  return out;
}

HarmonicBalance::LaneLoads HarmonicBalance::lane_loads(const LaneRows& y, const Lanes& w_rad_s,
                                                       const Lanes& earlier_peak,
                                                       const double drive_share) const {
  const LaneRows values = basis_.samples(y);
  LaneRows rates = basis_.rates(y);
  rates.rowwise() *= w_rad_s.transpose();
  const Eigen::Index n = values.rows();
  LaneRows torque = LaneRows::Zero(n, n_lanes),
           external = LaneRows::Zero(basis_.n_coordinates(), n_lanes);
  const auto laws = laws_of(chain_, drive_.record_number);
  const Lanes dt = 2. * M_PI / (w_rad_s * static_cast<double>(basis_.n_samples_of_period()));
  const auto pass = [&](const double sign, const bool commit) {
    for (Eigen::Index i = 0; i < n; ++i)
      for (const auto& law : laws)
        torque.row(i) += law->moment(sign * values.row(i).transpose(),
                                     sign * rates.row(i).transpose(), Lanes::Zero(), dt(0), commit)
                             .transpose();
  };
  for (const auto& law : laws) law->remember_peak(earlier_peak);
  if (has_memory_) {
    pass(1., true);
    if (basis_.only_odd()) pass(-1., true);
    torque.setZero();
  }
  pass(1., has_memory_);
  if (chain_.relative_wind.on && drive_.wind_speed_m_s) {
    // Base velocity A / (j w).
    LaneRows velocity = LaneRows::Zero(y.rows(), n_lanes);
    const Lanes acceleration =
        w_rad_s.unaryExpr([&](const double w) { return drive_.acceleration_at(w); });
    velocity.row(basis_.fundamental() + 1) = -drive_share * (acceleration / w_rad_s).transpose();
    const LaneRows base = basis_.samples(velocity);
    LaneRows load(n, n_lanes);
    for (Eigen::Index i = 0; i < n; ++i)
      load.row(i) =
          wind_gain_ * relative_drag(chain_.relative_wind, Lanes::Constant(*drive_.wind_speed_m_s),
                                     base.row(i).transpose(), rates.row(i).transpose())
                           .transpose();
    external = basis_.coordinates(load);
  }
  return {.torque = basis_.coordinates(torque),
          .external = std::move(external),
          .peak = values.abs().colwise().maxCoeff().transpose()};
}

Eigen::VectorXd HarmonicBalance::error(const Eigen::VectorXd& y, const Coefficients& coefficients,
                                       const LaneLoads& loads, const Eigen::Index lane) const {
  Eigen::VectorXd out = y - coefficients.linear;
  for (std::size_t k = 0; k < coefficients.torque.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    set_order(out, i,
              order_of(out, i) - coefficients.torque[k] * order_of(loads.torque, i, lane) -
                  coefficients.external[k] * order_of(loads.external, i, lane));
  }
  return out;
}

HarmonicBalance::Linearised HarmonicBalance::linearised(const PeriodicMotion& motion,
                                                        const double drive_share) const {
  constexpr double relative_step = 1e-6;
  const Eigen::Index n = basis_.n_coordinates();
  const double w = motion.w_rad_s, moved_w = w * (1. + relative_step);
  const double step = relative_step * (motion.y.norm() + 1e-300);
  const Coefficients here = coefficients(w, drive_share),
                     moved = coefficients(moved_w, drive_share);
  Linearised out{.error = {}, .by_frequency = {}, .by_coordinates = Eigen::MatrixXd(n, n)};
  // Candidates: the motion, the motion at another frequency, then each coordinate moved.
  for (Eigen::Index first = 0; first < n + 2; first += n_lanes) {
    LaneRows y = same_in_all_lanes(motion.y);
    Lanes frequency = Lanes::Constant(w);
    const Eigen::Index end = std::min(first + n_lanes, n + 2);
    for (Eigen::Index i = first; i < end; ++i) {
      if (i == 1) frequency(i - first) = moved_w;
      if (i > 1) y(i - 2, i - first) += step;
    }
    const LaneLoads loads =
        lane_loads(y, frequency, Lanes::Constant(motion.earlier_peak), drive_share);
    for (Eigen::Index i = first; i < end; ++i) {
      const Eigen::VectorXd error_there =
          error(y.col(i - first), i == 1 ? moved : here, loads, i - first);
      if (i == 0) {
        out.error = error_there;
        out.peak = loads.peak(0);
      } else if (i == 1) {
        out.by_frequency = (error_there - out.error) / (moved_w - w);
      } else {
        out.by_coordinates.col(i - 2) = (error_there - out.error) / step;
      }
    }
  }
  return out;
}

HarmonicBalance::Loads HarmonicBalance::loads(const PeriodicMotion& motion) const {
  const InLanes lanes = in_lanes({&motion, 1});
  const LaneLoads loads = lane_loads(lanes.y, lanes.w, lanes.earlier_peak, 1.);
  return {.torque = loads.torque.col(0), .external = loads.external.col(0)};
}

Complex HarmonicBalance::reading(const PeriodicMotion& motion, const LaneLoads& loads,
                                 const Eigen::Index lane) const {
  const Complex s(0., motion.w_rad_s);
  const LinearPart part = response_.at(s, drive_.readout);
  Eigen::VectorXd moment = Eigen::VectorXd::Zero(basis_.n_coordinates());
  const Eigen::VectorXd added = motion.y - linear_motion(motion.w_rad_s, 1., part);
  for (std::size_t k = 0; k < basis_.orders().size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Complex y = order_of(added, i);
    const Complex stiffness =
        joint_.changed_stiffness_ratio(static_cast<double>(basis_.orders()[k]) * s);
    set_order(moment, i,
              drive_.readout == signals::Readout::rotation
                  ? y
                  : stiffness * y + order_of(loads.torque, i, lane));
  }
  const Eigen::Index i = basis_.fundamental() / 2;
  set_order(moment, i, order_of(moment, i) + part.base * drive_.acceleration_at(motion.w_rad_s));
  if (!basis_.only_odd()) moment(0) += steady_moment_;
  if (chain_.readout.empty()) return part.sensor * order_of(moment, i);
  // A static law may have even terms, which the odd orders alone cannot carry.
  const FourierBasis whole(basis_.highest(), false);
  LaneRows samples = whole.samples(same_in_all_lanes(whole.converted(moment, basis_)));
  for (const auto& law : chain_.readout)
    for (Eigen::Index j = 0; j < samples.rows(); ++j) samples(j, 0) = law(samples(j, 0));
  return part.sensor * order_of(whole.coordinates(samples).col(0), whole.fundamental() / 2);
}

std::vector<Complex> HarmonicBalance::readings(std::span<const PeriodicMotion> motions) const {
  const InLanes lanes = in_lanes(motions);
  const LaneLoads loads = lane_loads(lanes.y, lanes.w, lanes.earlier_peak, 1.);
  std::vector<Complex> out;
  for (std::size_t i = 0; i < motions.size(); ++i)
    out.push_back(reading(motions[i], loads, static_cast<Eigen::Index>(i)));
  return out;
}

std::vector<HarmonicBalance::Coefficients> HarmonicBalance::coefficients_of(
    const std::span<const PeriodicMotion> motions) const {
  std::vector<Coefficients> out;
  for (const PeriodicMotion& motion : motions) out.push_back(coefficients(motion.w_rad_s, 1.));
  return out;
}

std::vector<Eigen::VectorXd> HarmonicBalance::errors(
    std::span<const PeriodicMotion> motions) const {
  return errors(motions, coefficients_of(motions));
}

void HarmonicBalance::correct(const std::span<PeriodicMotion> motions,
                              const std::span<const Eigen::MatrixXd* const> inverse,
                              const int n_iterations) const {
  const std::vector<Coefficients> known = coefficients_of(motions);
  std::vector<PeriodicMotion> trial(motions.begin(), motions.end());
  constexpr double accurate = 1e-6;  // of a motion; far below what higher harmonics change
  std::vector<double> least(motions.size(), std::numeric_limits<double>::infinity());
  bool is_accurate = false;
  for (int k = 0; k <= n_iterations && !is_accurate; ++k) {
    const std::vector<Eigen::VectorXd> error = errors(trial, known);
    is_accurate = true;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Eigen::VectorXd step = *inverse[i] * error[i];
      if (!(step.norm() < least[i])) continue;
      least[i] = step.norm();
      motions[i] = trial[i];
      trial[i].y -= step;
      is_accurate = is_accurate && least[i] <= accurate * motions[i].y.norm();
    }
  }
}

std::vector<Eigen::VectorXd> HarmonicBalance::errors(
    const std::span<const PeriodicMotion> motions,
    const std::span<const Coefficients> coefficients) const {
  const InLanes lanes = in_lanes(motions);
  const LaneLoads loads = lane_loads(lanes.y, lanes.w, lanes.earlier_peak, 1.);
  std::vector<Eigen::VectorXd> out;
  for (std::size_t i = 0; i < motions.size(); ++i)
    out.push_back(error(motions[i].y, coefficients[i], loads, static_cast<Eigen::Index>(i)));
  return out;
}

std::vector<double> HarmonicBalance::neglected(std::span<const PeriodicMotion> motions) const {
  const HarmonicBalance finer(chain_, drive_, 3 * basis_.highest());
  std::vector<PeriodicMotion> same(motions.begin(), motions.end());
  for (PeriodicMotion& motion : same) motion.y = finer.basis_.converted(motion.y, basis_);
  std::vector<double> out;
  for (Eigen::VectorXd& missing : finer.errors(same)) {
    missing.head(basis_.n_coordinates()).setZero();
    out.push_back(missing.norm() / same[out.size()].y.norm());
  }
  return out;
}

}  // namespace vibrissa::diagnosis
