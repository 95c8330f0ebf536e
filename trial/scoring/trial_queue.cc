#include "trial/scoring/trial_queue.h"

#include <mpi.h>

namespace vibrissa::trial {

struct TrialQueue::Counter {
  MPI_Win window{};
  long* value = nullptr;
};

TrialQueue::TrialQueue() : counter_(std::make_unique<Counter>()) {
  const MPI_Aint size = rank() == 0 ? sizeof(long) : 0;
  MPI_Win_allocate(size, sizeof(long), MPI_INFO_NULL, MPI_COMM_WORLD, &counter_->value,
                   &counter_->window);
  if (rank() == 0) *counter_->value = 0;
  MPI_Win_lock_all(0, counter_->window);
  MPI_Barrier(MPI_COMM_WORLD);
}

TrialQueue::~TrialQueue() {
  MPI_Win_unlock_all(counter_->window);
  MPI_Win_free(&counter_->window);
}

std::size_t TrialQueue::next() {
  const long one = 1;
  long place = 0;
  MPI_Fetch_and_op(&one, &place, MPI_LONG, 0, 0, MPI_SUM, counter_->window);
  MPI_Win_flush(0, counter_->window);
  return static_cast<std::size_t>(place);
}

int TrialQueue::rank() const {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int TrialQueue::n_ranks() const {
  int n = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  return n;
}

std::vector<unsigned long> TrialQueue::total(std::vector<unsigned long> numbers) const {
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UNSIGNED_LONG,
                MPI_SUM, MPI_COMM_WORLD);
  return numbers;
}

}  // namespace vibrissa::trial
