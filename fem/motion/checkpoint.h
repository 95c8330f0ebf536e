#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fem/motion/transient_run.h"

namespace vibrissa::fem {

/// Whose checkpoint it is: no other run goes on from it.
struct CheckpointOwner {
  std::string case_text;                       // every entry, one a line
  std::map<std::string, std::string> digests;  // of what the case file names: "mesh", ...
  std::string program_revision;                // told, not compared
};

/// Writes what a run needs to go on and its record so far, whole or not at all: an HDF5 file of
/// vectors/, numbers/, own/ (of each process), record/ and owner/ behind 512 bytes of text with its
/// SHA-256, where HDF5 looks for a file's beginning, too. On several processes the first one
/// writes; all must call. Throws UserError when it cannot be written. Proven by
/// tests/fem/motion/checkpoint_test.cc and tests/apps/transient_test.cc.
void write_checkpoint(const std::filesystem::path& file, const TransientRun& run,
                      const CheckpointOwner& owner);

/// Puts a run that was just begun where a checkpoint is; what follows is bit for bit what the run
/// that wrote it would have done. Returns the revision of the program that wrote it. Throws
/// UserError with the reason for a file that is missing, damaged, of another kind, of other
/// parameters (names the first) or inputs, or of another number of processes.
std::string read_checkpoint(const std::filesystem::path& file, const CheckpointOwner& owner,
                            TransientRun& run);

}  // namespace vibrissa::fem
