#include "signals/fft.h"

#include <fftw3.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <new>
#include <string>

#include "signals/error.h"

namespace vibrissa::signals {

namespace {

// FFTW plans may be executed by any thread, but its planner is shared by all of them.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

// On a border of the widest vector: code that works on the buffers by vectors then splits them the
// same way, and so rounds the same way, in every object. FFTW's own allocator promises less.
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

}  // namespace

// The planner only estimates: measured plans vary from run to run in their last digits, and equal
// input must give equal output.
struct RealFft::Plans {
  explicit Plans(std::size_t n)
      : time(aligned_buffer<double>(n)), spectrum(aligned_buffer<fftw_complex>(n / 2 + 1)) {
    const std::lock_guard lock(planner_mutex());
    const int length = static_cast<int>(n);
    forward = fftw_plan_dft_r2c_1d(length, time.get(), spectrum.get(), FFTW_ESTIMATE);
    inverse = fftw_plan_dft_c2r_1d(length, spectrum.get(), time.get(), FFTW_ESTIMATE);
    assert(forward && inverse);
  }
  ~Plans() {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  std::unique_ptr<double, Free> time;
  std::unique_ptr<fftw_complex, Free> spectrum;
  fftw_plan forward = nullptr, inverse = nullptr;
};

RealFft::RealFft(std::size_t n) : n_(checked_length(n)), plans_(std::make_unique<Plans>(n)) {
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

struct ComplexFft::Plans {
  explicit Plans(std::size_t n)
      : time(aligned_buffer<fftw_complex>(n)), spectrum(aligned_buffer<fftw_complex>(n)) {
    const std::lock_guard lock(planner_mutex());
    const int length = static_cast<int>(n);
    forward = fftw_plan_dft_1d(length, time.get(), spectrum.get(), FFTW_FORWARD, FFTW_ESTIMATE);
    inverse = fftw_plan_dft_1d(length, spectrum.get(), time.get(), FFTW_BACKWARD, FFTW_ESTIMATE);
    assert(forward && inverse);
  }
  ~Plans() {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(forward);
    fftw_destroy_plan(inverse);
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  std::unique_ptr<fftw_complex, Free> time, spectrum;
  fftw_plan forward = nullptr, inverse = nullptr;
};

ComplexFft::ComplexFft(std::size_t n) : n_(checked_length(n)), plans_(std::make_unique<Plans>(n)) {
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
