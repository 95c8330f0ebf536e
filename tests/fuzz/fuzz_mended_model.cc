// Any bytes as a mended model: one that is written back the same, or a UserError; nothing else.
#include <cstdlib>
#include <string>

#include "diagnosis/mended_model_json.h"
#include "signals/error.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  try {
    const std::string text =
        diagnosis::mended_model_json(diagnosis::read_mended_model(file.path()));
    const fuzz::FileOfBytes written(reinterpret_cast<const std::uint8_t*>(text.data()),
                                    text.size());
    if (diagnosis::mended_model_json(diagnosis::read_mended_model(written.path())) != text)
      std::abort();
  } catch (const signals::UserError&) {
  }
  return 0;
}
