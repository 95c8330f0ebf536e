#pragma once

#include <string>

namespace vibrissa::faults {

/// Lets a fault happen in a child process while its parent, the job, waits: one run of the job
/// visits all faults, each at the cost of what is left to do after it. The child works on a copy of
/// the job's folder, in its open files, too; the job finds its own folder as it was.
class FaultChildren {
 public:
  /// talk: "READ,WRITE", descriptors by which a judge hears of each child and answers when it has
  /// looked at the folder and at FOLDER.said, where the child's standard output and error are.
  FaultChildren(const std::string& folder, const std::string& talk);

  /// True in the child, in which the fault is to happen; false in the job, after the child's end.
  /// The judge gets a line "WHAT STATUS"; status 1000 + n: ended by signal n; 2000: the job has
  /// other threads, which do more than wait for events; a child would not have them.
  bool is_child(const std::string& what);

 private:
  void set_folder_aside() const;
  void bring_folder_back() const;
  void become_child() const;
  void tell(const std::string& line) const;

  std::string folder_, kept_;
  int from_judge_ = -1, to_judge_ = -1;
};

}  // namespace vibrissa::faults
