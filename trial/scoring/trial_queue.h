#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace vibrissa::trial {

/// Distributes the numbers 0, 1, 2 ... to the ranks, each number to one rank (a counter on rank 0,
/// read and incremented atomically). Construction and destruction are collective. MPI must be
/// initialised. Proven by tests/apps/trial_test.cc.
class TrialQueue {
 public:
  TrialQueue();
  ~TrialQueue();
  TrialQueue(const TrialQueue&) = delete;
  TrialQueue& operator=(const TrialQueue&) = delete;

  std::size_t next();
  int rank() const;
  int n_ranks() const;
  /// Sum of each number over all ranks; every rank gets the result.
  std::vector<unsigned long> total(std::vector<unsigned long> numbers) const;

 private:
  struct Counter;
  std::unique_ptr<Counter> counter_;
};

}  // namespace vibrissa::trial
