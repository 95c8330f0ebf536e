#pragma once

#include <span>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/joint_model.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Is there anything in the chain that frequency lines cannot tell, for this record?
bool is_dynamic(const Chain& chain, const PreparedRecord& record);

/// Is the base's velocity taken from its acceleration at s? Where it hardly moves, integrated noise
/// would only drift.
bool gives_velocity(Complex s);

/// A record with the spectrum of the linear part's elastic joint moment [N m], lines
/// 0 .. n_samples / 2.
struct ElasticMoment {
  const PreparedRecord* record = nullptr;
  std::vector<Complex> spectrum;
};

/// What the simulation of one chain's dynamic parts takes; what it points at must outlive it.
struct DynamicTask {
  const Chain* chain = nullptr;
  const JointModel* joint = nullptr;
  std::vector<ElasticMoment> elastic{};
};

/// What joint laws and relative wind add to the base moments before the sensor [N m], or, under the
/// readout rotation, to the joint's elastic moments, at the records' samples: [task][record].
/// Integrated on a finer grid with a second-order exponential rule, records side by side; the
/// joint's law is solved implicitly. Tasks are stepped in turn: a step is a chain of dependent
/// operations, and the processor fills the waiting of one with another. Proven by
/// tests/diagnosis/prediction/chain_simulation_test.cc.
std::vector<std::vector<std::vector<double>>> dynamic_parts(std::span<const DynamicTask> tasks);

}  // namespace vibrissa::diagnosis
