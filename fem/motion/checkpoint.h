#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fem/motion/transient_run.h"

namespace vibrissa::fem {

/// The run that owns a checkpoint; no other run may resume from it.
struct CheckpointOwner {
  std::string case_text;                       // every entry, one in each line
  std::map<std::string, std::string> digests;  // digests of the files of the case: "mesh", ...
  std::string program_revision;                // reported, not compared
};

/// Writes the state that a run needs to resume, and its record so far, completely or not at all.
/// The HDF5 file contains vectors/, numbers/, own/ (of each process), record/ and owner/; 512 bytes
/// of text with its SHA-256 precede it (HDF5 also searches for the start there). With several
/// processes the first one writes; all must call the function. Throws UserError when it cannot be
/// written. Proven by tests/fem/motion/checkpoint_test.cc and tests/apps/transient_test.cc.
void write_checkpoint(const std::filesystem::path& file, const TransientRun& run,
                      const CheckpointOwner& owner);

/// Sets a new run to the state of a checkpoint; its further results equal those of the run that
/// wrote it, bit for bit. Returns the revision of the program that wrote it. Throws UserError with
/// the reason when the file is missing, damaged, of another type, of other parameters (names the
/// first difference) or inputs, or of another number of processes.
std::string read_checkpoint(const std::filesystem::path& file, const CheckpointOwner& owner,
                            TransientRun& run);

}  // namespace vibrissa::fem
