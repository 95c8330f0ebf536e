#include "separation/filters/separator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <deque>

#include "separation/filters/block_separator.h"
#include "separation/stream_methods.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::Record;
using signals::UserError;
using test::Signal;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// M - a, block by block; counts resets.
class Difference : public BlockSeparator {
 public:
  using BlockSeparator::BlockSeparator;
  std::string name() const override { return "difference"; }
  int n_resets = 0;

 private:
  void process_block(std::span<const double> a, std::span<const double> m,
                     std::span<double> wind) override {
    for (std::size_t i = 0; i < wind.size(); ++i) wind[i] = m[i] - a[i];
  }
  void reset_blocks() override { ++n_resets; }
};

TEST(BlockSeparator, GivesResultsLateByABlockLessOneWhateverTheChunks) {
  const std::size_t n = 1000;
  const Signal a = test::white_noise(n, 1., 1), m = test::white_noise(n, 1., 2);
  for (const std::size_t block : {1u, 2u, 20u, 64u}) {
    Difference separator(block);
    ASSERT_EQ(separator.latency_samples(), block - 1);
    Signal wind(n, 9.);
    std::mt19937 random(3);
    for (std::size_t done = 0; done < n;) {
      const std::size_t chunk = std::min<std::size_t>(random() % 90, n - done);
      separator.process(std::span(a).subspan(done, chunk), std::span(m).subspan(done, chunk),
                        std::span(wind).subspan(done, chunk));
      done += chunk;
    }
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_EQ(wind[i], i < block - 1 ? 0. : m[i - block + 1] - a[i - block + 1]) << block;
  }
}

TEST(BlockSeparator, NeedsABlock) {
  EXPECT_THAT([] { Difference separator(0); }, ThrowsMessage<UserError>(HasSubstr("block_length")));
}

Signal separated(const StreamMethod& method, const Signal& a, const Signal& m, Signal& wind,
                 std::size_t chunk) {
  const auto separator = method.make({});
  for (std::size_t i = 0; i < wind.size(); i += chunk) {
    const std::size_t n = std::min(chunk, wind.size() - i);
    separator->process(std::span(a).subspan(i, n), std::span(m).subspan(i, n),
                       std::span(wind).subspan(i, n));
  }
  return wind;
}

TEST(StreamMethods, MayWriteOverAnInput) {
  const Signal a = test::white_noise(1000, 1., 1), m = test::white_noise(1000, 1., 2);
  for (const StreamMethod& method : stream_methods())
    for (const std::size_t chunk : {7u, 20u, 1000u}) {
      Signal wind(1000), over_a = a, over_m = m;
      const Signal apart = separated(method, a, m, wind, chunk);
      EXPECT_EQ(separated(method, over_a, m, over_a, chunk), apart) << method.name << ' ' << chunk;
      EXPECT_EQ(separated(method, a, over_m, over_m, chunk), apart) << method.name << ' ' << chunk;
    }
}

Record record_of(const Signal& a, const Signal& m) {
  Record record(500., a.size());
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment, m);
  return record;
}

TEST(SeparateRecord, IsAlignedWithTheRecordAndAsLong) {
  const Signal a = test::white_noise(333, 1., 1), m = test::white_noise(333, 1., 2);
  for (const std::size_t block : {1u, 20u, 64u, 500u}) {
    Difference separator(block);
    EXPECT_EQ(separate_record(separator, record_of(a, m)), test::minus(m, a)) << block;
  }
}

TEST(SeparateRecord, StartsAfresh) {
  const Signal a = test::white_noise(100, 1., 1);
  Difference separator(16);
  Signal wind(7);
  separator.process(std::span(a).first(7), std::span(a).first(7), wind);
  separate_record(separator, record_of(a, a));
  EXPECT_EQ(separator.n_resets, 1);
}

TEST(SeparateRecord, NamesTheChannelAndThePlaceOfWhatIsWrong) {
  Difference separator(4);
  Signal a = test::white_noise(100, 1., 1), m = a;
  m[50] = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { separate_record(separator, record_of(a, m)); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("base_moment_N_m"), HasSubstr("sample 50 (0.1 s)"))));
  Record record(500., 100);
  record.set_channel(signals::channel::base_moment, a);
  EXPECT_THAT([&] { separate_record(separator, record); },
              ThrowsMessage<UserError>(HasSubstr("base_acceleration_m_s2")));
}

}  // namespace
}  // namespace vibrissa::separation
