#include "diagnosis/checks/finding.h"

#include <sstream>

namespace vibrissa::diagnosis {

#define VIBRISSA_AS_TEXT(...) #__VA_ARGS__
#define VIBRISSA_NAMES(...) VIBRISSA_AS_TEXT(__VA_ARGS__)

std::string to_string(const FindingKind kind) {
  std::istringstream names(VIBRISSA_NAMES(VIBRISSA_FINDING_KINDS));
  std::string name;
  for (int i = 0; i <= static_cast<int>(kind); ++i) std::getline(names >> std::ws, name, ',');
  return name;
}

}  // namespace vibrissa::diagnosis
