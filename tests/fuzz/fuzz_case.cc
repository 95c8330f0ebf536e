// Any bytes as a case file: a case whose resolved text reads back to the same, or a UserError;
// nothing else.
#include <cstdlib>
#include <string>

#include "case/case_file.h"
#include "signals/base/error.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  std::string text;
  try {
    sensor_case::CaseFile read(file.path());
    read.read();
    text = read.resolved();
  } catch (const signals::UserError&) {
    return 0;
  }
  const fuzz::FileOfBytes written(text);
  sensor_case::CaseFile again(written.path());
  again.read();
  if (again.resolved() != text) std::abort();
  return 0;
}
