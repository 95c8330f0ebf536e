// Any bytes as an updated model: one that is written back the same, or a UserError; nothing else.
#include <cstdlib>
#include <string>

#include "diagnosis/model/updated_model.h"
#include "signals/base/error.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  std::string text;
  try {
    text = diagnosis::updated_model_json(diagnosis::read_updated_model(file.path()));
  } catch (const signals::UserError&) {
    return 0;
  }
  const fuzz::FileOfBytes written(text);
  if (diagnosis::updated_model_json(diagnosis::read_updated_model(written.path())) != text)
    std::abort();
  return 0;
}
