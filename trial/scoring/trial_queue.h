#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace vibrissa::trial {

/// Numbers 0 .. n-1, each handed to one of the ranks that ask (one counter on rank 0, fetched and
/// raised in one step). Collective: every rank makes and ends it. MPI must have been started.
/// Proven by tests/apps/trial_test.cc.
class TrialQueue {
 public:
  TrialQueue();
  ~TrialQueue();
  TrialQueue(const TrialQueue&) = delete;
  TrialQueue& operator=(const TrialQueue&) = delete;

  std::size_t next();
  int rank() const;
  int n_ranks() const;
  /// Sum of each number over all ranks, on every one of them.
  std::vector<unsigned long> total(std::vector<unsigned long> numbers) const;

 private:
  struct Counter;
  std::unique_ptr<Counter> counter_;
};

}  // namespace vibrissa::trial
