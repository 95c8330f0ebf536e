#include "checks/record_report.h"

namespace vibrissa::checks {

std::string to_string(const Severity severity) {
  if (severity == Severity::note) return "note";
  return severity == Severity::limits ? "limits" : "stops";
}

std::string to_string(const DriveKind kind) {
  switch (kind) {
    case DriveKind::none:
      return "none";
    case DriveKind::random_or_other:
      return "random or other";
    case DriveKind::periodic:
      return "periodic";
    case DriveKind::hits:
      return "hits";
  }
  return "";
}

}  // namespace vibrissa::checks
