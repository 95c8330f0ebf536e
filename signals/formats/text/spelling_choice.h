#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "signals/formats/text/table_layout.h"

namespace vibrissa::signals::formats {

/// One way to read the lines of a table.
struct Reading {
  Spelling spelling;
  std::size_t n_fields = 0;
  std::vector<bool> is_numeric = {};  // for each column: whether most of its fields are numbers
  std::size_t n_numeric = 0, n_rows = 0;
  std::size_t n_odd = 0;  // rows of another length or with unseparated numbers
  bool has_numbers() const { return n_numeric > 0; }
};

/// Whether a line is a row of such a table: a number or nothing in every column of numbers.
bool is_row(const Reading& reading, const std::string& line);
/// Whether the line has no number, and a field for each column of numbers: names or units.
bool may_be_names(const Reading& reading, const std::string& line);

/// The way that explains the lines; one without numbers where there are none. Throws UserError
/// where two ways explain them equally, or none does.
Reading choose_reading(const std::string& file, const FileBytes& bytes,
                       const std::vector<HeadLine>& head, const TextOptions& options);

}  // namespace vibrissa::signals::formats
