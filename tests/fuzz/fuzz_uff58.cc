#include "signals/formats/uff58/uff58_record.h"
#include "tests/fuzz/table_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vibrissa::fuzz::read_table(vibrissa::signals::formats::read_uff58_table, data, size);
}
