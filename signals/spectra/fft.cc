#include "signals/spectra/fft.h"

#include <fftw3.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <new>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::signals {

namespace {

// Any thread may execute FFTW plans, but all threads share the planner.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

// Aligned to the widest SIMD register: vectorised code then splits the buffers, and rounds, equally
// in every object. The allocator of FFTW guarantees less.
template <typename T>
std::unique_ptr<T, Free> aligned_buffer(std::size_t n) {
  constexpr std::size_t border = 64;
  const std::size_t n_bytes = (n * sizeof(T) + border - 1) / border * border;
  std::unique_ptr<T, Free> buffer(static_cast<T*>(std::aligned_alloc(border, n_bytes)));
  if (!buffer) throw std::bad_alloc();
  return buffer;
}

std::size_t checked_length(std::size_t n) {
  if (n == 0 || n > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw UserError("a Fourier transform needs between 1 and " +
                    std::to_string(std::numeric_limits<int>::max()) + " samples, not " +
                    std::to_string(n));
  return n;
}

/// A forward and an inverse plan between two own buffers. The plans are estimated, not measured:
/// measured plans give different last digits from run to run, but equal input must give equal
/// output.
template <typename Time>
struct PlanPair {
  template <typename Forward, typename Inverse>
  PlanPair(std::size_t n_time, std::size_t n_spectrum, Forward plan_forward, Inverse plan_inverse)
      : time(aligned_buffer<Time>(n_time)), spectrum(aligned_buffer<fftw_complex>(n_spectrum)) {
    const std::lock_guard lock(planner_mutex());
    forward = plan_forward(time.get(), spectrum.get());
    inverse = plan_inverse(spectrum.get(), time.get());
    assert(forward && inverse);
  }
  ~PlanPair() {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  PlanPair(const PlanPair&) = delete;
  PlanPair& operator=(const PlanPair&) = delete;

  std::unique_ptr<Time, Free> time;
  std::unique_ptr<fftw_complex, Free> spectrum;
  fftw_plan forward = nullptr, inverse = nullptr;
};

}  // namespace

struct RealFft::Plans : PlanPair<double> {
  explicit Plans(int n)
      : PlanPair(
            static_cast<std::size_t>(n), static_cast<std::size_t>(n) / 2 + 1,
            [n](double* x, fftw_complex* s) {
              return fftw_plan_dft_r2c_1d(n, x, s, FFTW_ESTIMATE);
            },
            [n](fftw_complex* s, double* x) {
              return fftw_plan_dft_c2r_1d(n, s, x, FFTW_ESTIMATE);
            }) {}
};

RealFft::RealFft(std::size_t n)
    : n_(checked_length(n)), plans_(std::make_unique<Plans>(static_cast<int>(n))) {
  std::ranges::fill(time(), 0.);
  std::ranges::fill(spectrum(), 0.);
}

RealFft::~RealFft() = default;
RealFft::RealFft(RealFft&&) noexcept = default;
RealFft& RealFft::operator=(RealFft&&) noexcept = default;

std::span<double> RealFft::time() {
  return {plans_->time.get(), n_};
}

// FFTW documents fftw_complex as bit-compatible with std::complex<double>.
std::span<std::complex<double>> RealFft::spectrum() {
  return {reinterpret_cast<std::complex<double>*>(plans_->spectrum.get()), n_bins()};
}

void RealFft::forward() {
  fftw_execute(plans_->forward);
}

void RealFft::inverse() {
  fftw_execute(plans_->inverse);
  const double scale = 1. / static_cast<double>(n_);
  for (double& x : time()) x *= scale;
}

struct ComplexFft::Plans : PlanPair<fftw_complex> {
  explicit Plans(int n)
      : PlanPair(static_cast<std::size_t>(n), static_cast<std::size_t>(n), Towards{n, FFTW_FORWARD},
                 Towards{n, FFTW_BACKWARD}) {}

  struct Towards {
    int n, direction;
    fftw_plan operator()(fftw_complex* from, fftw_complex* to) const {
      return fftw_plan_dft_1d(n, from, to, direction, FFTW_ESTIMATE);
    }
  };
};

ComplexFft::ComplexFft(std::size_t n)
    : n_(checked_length(n)), plans_(std::make_unique<Plans>(static_cast<int>(n))) {
  std::ranges::fill(time(), 0.);
  std::ranges::fill(spectrum(), 0.);
}

ComplexFft::~ComplexFft() = default;
ComplexFft::ComplexFft(ComplexFft&&) noexcept = default;
ComplexFft& ComplexFft::operator=(ComplexFft&&) noexcept = default;

std::span<std::complex<double>> ComplexFft::time() {
  return {reinterpret_cast<std::complex<double>*>(plans_->time.get()), n_};
}

std::span<std::complex<double>> ComplexFft::spectrum() {
  return {reinterpret_cast<std::complex<double>*>(plans_->spectrum.get()), n_};
}

void ComplexFft::forward() {
  fftw_execute(plans_->forward);
}

void ComplexFft::inverse() {
  fftw_execute(plans_->inverse);
}

std::vector<std::complex<double>> real_fft(std::span<const double> x) {
  RealFft fft(x.size());
  std::ranges::copy(x, fft.time().begin());
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

}  // namespace vibrissa::signals
