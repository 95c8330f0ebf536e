#pragma once

#include <cstdlib>
#include <memory>
#include <numeric>

#include "signals/base/error.h"
#include "signals/formats/record_table.h"
#include "tests/fuzz/file_of_bytes.h"

namespace vibrissa::fuzz {

/// Any bytes as a file of one format: a table whose every column can be read and has every row, or
/// a UserError; nothing else.
template <typename Reader>
int read_table(const Reader& reader, const std::uint8_t* data, const std::size_t size) {
  const FileOfBytes file(data, size);
  try {
    const std::unique_ptr<signals::formats::RecordTable> table = reader(file.path());
    std::vector<std::size_t> columns(table->columns().size());
    std::iota(columns.begin(), columns.end(), std::size_t{0});
    if (columns.empty() || table->n_rows() == 0) std::abort();
    for (const auto& values : table->read({columns, 1, table->n_rows(), columns.back()}).columns)
      if (values.size() != table->n_rows()) std::abort();
    table->text(table->n_rows(), columns.back());
  } catch (const signals::UserError&) {
  }
  return 0;
}

}  // namespace vibrissa::fuzz
