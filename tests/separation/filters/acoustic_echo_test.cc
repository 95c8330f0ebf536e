#include <gmock/gmock.h>
#include <speex/speex_echo.h>

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include "separation/filters/kalman_filter.h"
#include "signals/formats/wav_file.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

namespace fs = std::filesystem;
using test::Signal;

constexpr std::size_t n_taps = 2048, block = 128;

struct EchoPair {
  Signal far, near;
  double sampling_rate_hz;
};

fs::path folder() {
  return fs::path(VIBRISSA_SOURCE_DIR) / ".." / "shared" / "real" / "acoustic_echo_wav";
}

// SpeexDSP takes the lowest frequencies out of the microphone before it begins, which is no removal
// of echo; both start without them.
void remove_offset(Signal& x) {
  double last_in = 0., last_out = 0.;
  for (double& value : x) {
    last_out = value - last_in + 0.982 * last_out;
    last_in = std::exchange(value, last_out);
  }
}

EchoPair read_pair(const std::string& far, const std::string& near) {
  const auto f = signals::read_wav(folder() / far), n = signals::read_wav(folder() / near);
  EchoPair pair{f.channels.at(0), n.channels.at(0), f.sampling_rate_hz};
  const std::size_t length = std::min(pair.far.size(), pair.near.size()) / block * block;
  pair.far.resize(length);
  pair.near.resize(length);
  remove_offset(pair.far);
  remove_offset(pair.near);
  return pair;
}

Signal ours(const EchoPair& pair) {
  KalmanOptions options;
  options.block_length = block;
  options.filter_length = n_taps;
  options.transition = 0.99999;  // rooms move
  options.noise_forgetting = 0.95;
  PartitionedKalman filter(options);
  Signal tail_far = pair.far, tail_near = pair.near;
  tail_far.resize(pair.far.size() + block, 0.);
  tail_near.resize(tail_far.size(), 0.);
  Signal out(tail_far.size());
  filter.process(tail_far, tail_near, out);
  const auto latency = static_cast<std::ptrdiff_t>(filter.latency_samples());
  return {out.begin() + latency,
          out.begin() + latency + static_cast<std::ptrdiff_t>(pair.near.size())};
}

// The echo canceller alone: the residual suppressor is a separate preprocessor, which is not run.
Signal speex(const EchoPair& pair) {
  const std::unique_ptr<SpeexEchoState, decltype(&speex_echo_state_destroy)> state(
      speex_echo_state_init(block, n_taps), &speex_echo_state_destroy);
  auto rate = static_cast<spx_int32_t>(pair.sampling_rate_hz);
  speex_echo_ctl(state.get(), SPEEX_ECHO_SET_SAMPLING_RATE, &rate);
  Signal result;
  std::vector<spx_int16_t> far(block), near(block), out(block);
  for (std::size_t first = 0; first + block <= pair.far.size(); first += block) {
    for (std::size_t i = 0; i < block; ++i) {
      far[i] = static_cast<spx_int16_t>(std::lround(32768. * pair.far[first + i]));
      near[i] = static_cast<spx_int16_t>(std::lround(32768. * pair.near[first + i]));
    }
    speex_echo_cancellation(state.get(), near.data(), far.data(), out.data());
    for (const spx_int16_t value : out) result.push_back(value / 32768.);
  }
  return result;
}

double reduction_db(const Signal& near, const Signal& out) {
  return 20. * std::log10(test::rms(near) / test::rms(out));
}

void expect_reduced_as_by_speex(const std::string& far, const std::string& near) {
  const EchoPair pair = read_pair(far, near);
  const double ours_db = reduction_db(pair.near, ours(pair));
  EchoPair silent = pair;
  std::ranges::fill(silent.far, 0.);
  const double speex_db = reduction_db(speex(silent), speex(pair));
  std::cout << near << ": Kalman " << ours_db << " dB, SpeexDSP " << speex_db << " dB\n";
  EXPECT_GE(ours_db, speex_db) << near;
}

TEST(AcousticEcho, IsReducedAtLeastAsFarAsBySpeexDsp) {
  if (!fs::exists(folder())) GTEST_SKIP() << "no recordings in " << folder();
  expect_reduced_as_by_speex("real_linear_far.wav", "real_linear_near.wav");
  expect_reduced_as_by_speex("respeaker_far.wav", "respeaker_mic.wav");
}

}  // namespace
}  // namespace vibrissa::separation
