#pragma once

#include <span>
#include <string>
#include <vector>

#include "separation/filters/separator.h"

namespace vibrissa::separation {

/// A separator that works on whole blocks: it collects samples, processes full blocks, and returns
/// the results sample by sample with a latency of block_length - 1 samples.
class BlockSeparator : public Separator {
 public:
  explicit BlockSeparator(std::size_t block_length);

  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) final;
  void reset() final;
  std::size_t latency_samples() const final { return block_length() - 1; }
  std::size_t block_length() const { return acceleration_.size(); }

 private:
  virtual void process_block(std::span<const double> base_acceleration,
                             std::span<const double> base_moment,
                             std::span<double> wind_moment) = 0;
  virtual void reset_blocks() = 0;

  std::vector<double> acceleration_, moment_, wind_, next_wind_;
  std::size_t filled_ = 0;
};

}  // namespace vibrissa::separation
