#pragma once

#include <span>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/joint_model.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Does this record need time integration under the chain?
bool is_dynamic(const Chain& chain, const PreparedRecord& record);

/// Is the base velocity at s computed from the acceleration? Where the base hardly moves,
/// integrated noise would only drift.
bool gives_velocity(Complex s);

/// A record with the spectrum of the linear part's elastic joint moment [N m], lines
/// 0 .. n_samples / 2.
struct ElasticMoment {
  const PreparedRecord* record = nullptr;
  std::vector<Complex> spectrum;
};

/// Input of the time integration of one chain. The referenced objects must outlive it.
struct DynamicTask {
  const Chain* chain = nullptr;
  const JointModel* joint = nullptr;
  std::vector<ElasticMoment> elastic{};
};

/// Additions by joint laws and relative wind to the base moments before the sensor [N m], or with
/// the readout rotation to the joint's elastic moments, at the records' samples: [task][record].
/// Integrated on a finer grid with a second-order exponential rule, records in parallel lanes; the
/// joint's law is solved implicitly. Tasks are stepped in turn, so that the processor overlaps
/// their dependent operations. Proven by tests/diagnosis/prediction/chain_simulation_test.cc.
std::vector<std::vector<std::vector<double>>> dynamic_parts(std::span<const DynamicTask> tasks);

}  // namespace vibrissa::diagnosis
