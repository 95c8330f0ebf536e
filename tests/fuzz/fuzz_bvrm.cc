// Any bytes as a base vibration response model: one that passes its check and is written back the
// same, or a UserError; nothing else.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "separation/model/sampled_bvrm.h"
#include "signals/base/error.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  separation::SampledBvrm model;
  try {
    model = separation::read_bvrm(file.path());
  } catch (const signals::UserError&) {
    return 0;
  }
  separation::check(model.model);
  const auto json = separation::to_json(model);
  const auto again =
      separation::sampled_bvrm_from_json(nlohmann::json::parse(json.dump()), "again");
  if (separation::to_json(again) != json) std::abort();
  return 0;
}
