#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "separation/filters/separator.h"
#include "signals/files/record_stream.h"

namespace vibrissa::apps {

/// A separator and the name of its column, "wind_moment_NAME_N_m".
struct NamedSeparator {
  std::string name;
  std::unique_ptr<separation::Separator> separator;
};

/// Separates a record of any length in memory that does not grow with it, into a CSV record with
/// the channels that were read and one wind moment a method: the same bytes that separate_record
/// and write_record give. Proven by tests/apps/stream_test.cc.
void separate_stream(signals::RecordStream& record, std::vector<NamedSeparator>& methods,
                     const std::filesystem::path& output, bool show_progress);

}  // namespace vibrissa::apps
