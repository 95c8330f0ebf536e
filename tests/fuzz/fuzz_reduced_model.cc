// Any bytes as a reduced model: one that passes its check and is written back the same, or a
// UserError; nothing else.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "signals/model/reduced_model.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  signals::ReducedModel model;
  try {
    model = signals::read_reduced_model(file.path());
  } catch (const signals::UserError&) {
    return 0;
  }
  signals::check(model);
  const std::string text =
      signals::to_json(model).dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  const fuzz::FileOfBytes written(text);
  const auto again = signals::to_json(signals::read_reduced_model(written.path()));
  if (again.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) != text) std::abort();
  return 0;
}
