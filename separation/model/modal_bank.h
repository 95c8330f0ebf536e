#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "separation/model/mode_step.h"
#include "separation/model/rational_model.h"
#include "separation/numerics/all_pole_filter.h"

namespace vibrissa::separation {

/// State of 1 / (s^2 + a1 s + a0) driven by the base acceleration: position x [m], velocity x'
/// [m/s]. The moment of the mode is b0 x + b1 x'.
struct ModalState {
  double position_m = 0.;
  double velocity_m_s = 0.;
};

/// Simulates the sampled model as a stream, in blocks of any size, without allocation. Output n is
/// the moment at the time (n - fraction) / rate; the caller applies the shift() of the delay in
/// whole samples. Proven by tests/separation/model/simulation_test.cc.
class ModalBank {
 public:
  ModalBank(const Bvrm& model, double sampling_rate_hz, Hold hold);

  std::ptrdiff_t shift() const { return delay_.shift; }
  /// Restarts with these states at the first sample; empty: at rest.
  void reset(std::span<const ModalState> states = {});
  /// Takes n samples of the shaped input (see InputShaper; midpoint null when it has none) and
  /// writes n samples of output, which may be one of the inputs.
  void process(const double* node, const double* midpoint, const double* direct, double* output,
               std::size_t n);

 private:
  static constexpr std::size_t block = 256, history = 3;
  struct Mode {
    Mode(const ModalTerm& term, const ModeStep& step);
    void start(const ModalState& state, double first_node);
    void add_sample(double node, double& output);
    void add_output(const double* node, const double* midpoint, std::size_t n, double* output);
    AllPoleFilter filter;
    std::array<double, 4> taps;
    std::array<double, 3> mid_taps;
    std::array<std::array<double, 2>, 3> state_taps;
    double b1, b0, pole1, pole2;
    std::array<double, history + block> v{}, w{};
  };

  double start(double first_node, double first_direct);
  void process_block(const double* node, const double* midpoint, const double* direct,
                     double* output, std::size_t n);
  void start_with_direct(const double* node, const double* direct, std::size_t n);

  std::vector<Mode> modes_;
  std::vector<ModalState> first_states_;
  SampledDelay delay_;
  Hold hold_;
  double direct_term_;
  double last_node_ = 0.;
  bool started_ = false;
  std::array<double, block> sum_{};
};

}  // namespace vibrissa::separation
