#pragma once

#include "diagnosis/search/search.h"

namespace vibrissa::diagnosis {

/// A simulation and records.
struct SimulationAndRecords {
  UpdatedModel simulation;
  signals::Dataset real;
};

/// The same with the readout rotation; that of the simulation is kept where it is given.
SimulationAndRecords read_as_rotation(SimulationAndRecords given);

/// Does nobody say what is read, and does the best joint that is not linear explain the records
/// (given, as in the experiment), when they are read as rotation, better than any answer does as
/// moment? The moment of such a joint is not in proportion to its rotation. Proven by
/// tests/diagnosis/search/readout_choice_test.cc.
bool is_rotation(const SimulationAndRecords& given, const Experiment& experiment,
                 const SearchResult& result);

}  // namespace vibrissa::diagnosis
