#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "signals/base/line_reader.h"
#include "signals/formats/record_table.h"
#include "signals/formats/text/fields.h"

namespace vibrissa::signals::formats {

/// What the user says about a text table; what is absent is recognised from the file.
struct TextOptions {
  std::optional<char> separator = {}, decimal = {};
  std::optional<std::size_t> header_lines = {};  // lines before the first row
};

/// A sampling rate that the text states beside its columns.
struct StatedRate {
  double rate_hz = 0., start_s = 0.;
  std::string source = {};  // where it stands: "line 4"
  bool is_exact = false;    // the file has no stamps that tell more
};

/// How a text file is read as a table. Lines count from 1.
struct TableLayout {
  Spelling spelling;
  std::vector<std::string> names = {};
  std::vector<std::string> units = {};       // as many as names; empty where none is stated
  std::size_t line_of_names = 0;             // 0: the file has none
  std::size_t line_of_units = 0;             // 0: the file has none
  std::size_t first_line = 1, first_at = 0;  // of the first row: line and position in the file
  std::size_t n_fields = 0;                  // of most rows
  bool last_is_optional = false;             // rows may lack the last column, a comment
  bool is_labview = false;
  std::size_t rows_a_block = 0;  // 0: not stated
  std::optional<StatedRate> rate = {};
  std::vector<RateGroup> rate_groups = {};  // where the columns have several rates
};

/// The lines at the start of a file.
struct HeadLine {
  std::size_t number, at;
  std::string text;
};
std::vector<HeadLine> read_head_lines(const FileBytes& bytes, std::size_t start);

/// Recognises the layout from the first lines, and from all lines where they leave a doubt. Throws
/// UserError for an empty file, for a table that can be read in two ways (with both readings), and
/// for names that do not fit the rows. Proven by tests/signals/formats/text_file_test.cc and
/// text_layouts_test.cc.
TableLayout find_layout(const std::string& file, const FileBytes& bytes, std::size_t start,
                        const TextOptions& options);

/// "semicolons, decimal commas, names in line 4, units in line 5".
std::string to_string(const TableLayout& layout);

}  // namespace vibrissa::signals::formats
