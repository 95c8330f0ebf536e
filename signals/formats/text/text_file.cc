#include "signals/formats/text/text_file.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "signals/base/error.h"
#include "signals/formats/text/labview_layout.h"

namespace vibrissa::signals::formats {
namespace {

std::string text_of_line(const FileBytes& bytes, const std::size_t start, const std::size_t line) {
  LineReader lines(bytes, start, std::numeric_limits<std::size_t>::max());
  std::string_view text;
  for (std::size_t i = 0; i < line; ++i)
    if (!lines.next(text)) return {};
  return std::string(text);
}

}  // namespace

TextFile::TextFile(const std::filesystem::path& file, const TextOptions& options)
    : name_(file.string()),
      text_(open_text(file)),
      layout_(find_layout(name_, text_.bytes, text_.start, options)),
      line_of_names_(text_of_line(text_.bytes, text_.start, layout_.line_of_names)) {
  index_rows();
  last_ = {1, layout_.first_at};
}

bool TextFile::is_passed_over(const std::string_view line, bool& in_header) const {
  if (layout_.is_labview) {
    if (in_header || begins_labview_header(line)) {
      in_header = !ends_labview_header(line);
      return true;
    }
    if (ends_labview_header(line)) return true;
  }
  // Most rows begin with a digit or a sign.
  if (!line.empty() && line.front() >= '+' && line.front() <= '9' && line.front() != '/')
    return false;
  return is_blank(line) || is_comment(line) || (!line_of_names_.empty() && line == line_of_names_);
}

// Tables of spreadsheets end in rows of empty fields.
bool TextFile::is_without_values(const std::string_view line) const {
  return line.find_first_not_of(" \t\r\n,;\"") == std::string_view::npos;
}

bool TextFile::next_row(LineReader& lines, std::string_view& line, Place& place) const {
  while (lines.next(line))
    if (!is_passed_over(line, place.in_header)) return true;
  return false;
}

void TextFile::index_rows() {
  LineReader lines(text_.bytes, layout_.first_at, std::numeric_limits<std::size_t>::max());
  std::size_t n_lines = 0, n_rows = 0, n_passed = 0;
  end_ = layout_.first_at;
  std::size_t at = lines.position();
  bool in_header = false, is_new_block = false;
  for (std::string_view line; lines.next(line); at = lines.position()) {
    ++n_lines;
    if (is_passed_over(line, in_header)) {
      ++n_passed;
      is_new_block =
          is_new_block || in_header || (!line_of_names_.empty() && line == line_of_names_);
      continue;
    }
    ++n_rows;
    if (n_passed != (shifts_.empty() ? 0 : shifts_.back().second))
      shifts_.emplace_back(n_rows, n_passed);
    if (is_new_block && n_rows > 1) block_starts_.push_back(n_rows);
    is_new_block = false;
    if (is_without_values(line)) continue;
    end_ = at + line.size();
    n_rows_ = n_rows;
  }
  std::erase_if(block_starts_, [&](const std::size_t row) { return row > n_rows_ && row > 1; });
  const std::size_t block = layout_.rows_a_block;
  if (block_starts_.size() == 1 && block > 1)
    for (std::size_t row = block + 1; row <= n_rows_; row += block) block_starts_.push_back(row);
}

std::size_t TextFile::line_of(const std::size_t row) const {
  if (row == 0) return std::max<std::size_t>(layout_.line_of_names, 1);
  const auto after = std::upper_bound(
      shifts_.begin(), shifts_.end(), row,
      [](const std::size_t wanted, const auto& shift) { return wanted < shift.first; });
  const std::size_t n_passed = after == shifts_.begin() ? 0 : std::prev(after)->second;
  return layout_.first_line + (row - 1) + n_passed;
}

void TextFile::for_each_row(const std::size_t first, const std::size_t count,
                            const RowReader& read) const {
  assert(first >= 1 && first - 1 <= n_rows_ && count <= n_rows_ - (first - 1));
  Place place = first >= last_.row ? last_ : Place{1, layout_.first_at};
  LineReader lines(text_.bytes, place.at, end_);
  std::string_view line;
  const auto go_on = [&](const std::size_t row) {
    if (!next_row(lines, line, place))
      throw UserError(this->place(line_of(row)) + "the file ended unexpectedly while it was read");
  };
  for (std::size_t row = place.row; row < first; ++row) go_on(row);
  std::vector<std::string_view> fields;
  auto shift = std::upper_bound(
      shifts_.begin(), shifts_.end(), first,
      [](const std::size_t wanted, const auto& one) { return wanted < one.first; });
  std::size_t number = line_of(first);
  for (std::size_t row = first; row < first + count; ++row, ++number) {
    if (shift != shifts_.end() && row >= shift->first) number = line_of((shift++)->first);
    go_on(row);
    split_fields(line, layout_.spelling.separator, fields);
    if (fields.size() != layout_.names.size()) fit_fields(number, fields);
    read(number, fields);
  }
  last_ = {first + count, lines.position(), place.in_header};
}

// Empty last fields may be missing or too many.
void TextFile::fit_fields(const std::size_t line, std::vector<std::string_view>& fields) const {
  const std::size_t wanted = layout_.names.size(), n = fields.size();
  while (fields.size() > wanted && fields.back().empty()) fields.pop_back();
  const std::size_t least = layout_.last_is_optional ? wanted - 1 : layout_.n_fields;
  if (fields.size() >= least && fields.size() < wanted) fields.resize(wanted);
  if (fields.size() != wanted) refuse_row(line, n);
}

void TextFile::refuse_row(const std::size_t line, const std::size_t n_fields) const {
  const std::size_t names = layout_.line_of_names;
  const std::string where = names == 0   ? "most rows have "
                            : names == 1 ? "the first line names "
                                         : "line " + std::to_string(names) + " names ";
  throw UserError(place(line) + std::to_string(n_fields) + (n_fields == 1 ? " field" : " fields") +
                  ", but " + where + std::to_string(columns().size()) +
                  (columns().size() == 1 ? " column" : " columns"));
}

std::string TextFile::place(const std::size_t line) const {
  return name_ + ":" + std::to_string(line) + ": ";
}

}  // namespace vibrissa::signals::formats
