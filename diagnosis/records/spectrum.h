#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// DFT lines 0 .. n/2 of real samples, unscaled, and the inverse transform to n samples. Plans are
/// cached per thread.
std::vector<Complex> spectrum_of(std::span<const double> x);
std::vector<double> samples_of(std::span<const Complex> spectrum, std::size_t n);

/// The spectrum at the output of a linear path with this response to s = j 2 pi f, whose input has
/// n samples.
std::vector<Complex> passed(std::vector<Complex> spectrum, std::size_t n, double rate_hz,
                            const std::function<Complex(Complex s)>& response);

/// Spectrum of the moment that a model predicts for n samples of base acceleration and wind speed;
/// either may be empty.
std::vector<Complex> nominal_moment(const NominalModel& nominal, std::size_t n, double rate_hz,
                                    std::span<const double> acceleration,
                                    std::span<const double> wind);

/// The samples of a spectrum at factor times its rate (band-limited interpolation), factor n of
/// them.
std::vector<double> upsampled(std::span<const Complex> spectrum, std::size_t n, std::size_t factor);

/// n_out samples of the periodic signal of a spectrum, at the indices start + i step of its n
/// samples, by cubic interpolation on a four times finer grid.
std::vector<double> resampled(std::span<const Complex> spectrum, std::size_t n, std::size_t n_out,
                              double start, double step);

/// a - b, element by element.
std::vector<Complex> difference(std::span<const Complex> a, std::span<const Complex> b);

/// |x|^2 of each element.
std::vector<double> powers(std::span<const Complex> x);
/// Sum of |x|^2.
double total_power(std::span<const Complex> x);

/// u |u| of each value.
std::vector<double> signed_squares(std::span<const double> u);

/// Mean of the squares, about zero.
double mean_square(std::span<const double> x);
/// Root mean square about the mean.
double rms_about_mean(std::span<const double> x);

/// Mean of each value and its existing neighbours up to reach indices away.
std::vector<double> neighbour_mean(std::span<const double> x, std::size_t reach);

/// Noise power at the bins 1 .. n_evaluated/2 - 1 of a part, relative to white noise of unit share,
/// for noise with these shares at the lines 0 .. n_samples/2 of the whole record. A line whose
/// period does not divide the part spreads over several bins:
///   bin(b) = sum_k share(k) sinc^2(d_k) / sum_k sinc^2(d_k),   d_k = k n_evaluated / n_samples -
///   b.
/// For a part that is the whole record (of even length) bins and lines are identical. Proven by
/// tests/diagnosis/records/share_at_bins_test.cc.
std::vector<double> share_at_bins(std::span<const double> share_at_lines, std::size_t n_samples,
                                  std::size_t n_evaluated);

/// Largest even length up to n whose transform is fast (factors 2, 3, 5, 7).
std::size_t fast_length(std::size_t n);

/// Ratio of mean to median power, scaled to 1 for white noise; it is much larger for tones and
/// narrow bands.
double colour(std::vector<double> power);

}  // namespace vibrissa::diagnosis
