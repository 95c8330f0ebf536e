#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/trimmed.h"
#include "signals/base/utf_8.h"
#include "signals/formats/number_bytes.h"
#include "signals/formats/numeric_table.h"
#include "signals/formats/uff58_file.h"
#include "signals/system/file_bytes.h"

namespace vibrissa::signals::formats {
namespace {

constexpr std::string_view delimiter = "    -1";

/// Reads the lines of a file that may contain blocks of raw bytes.
class Lines {
 public:
  Lines(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  bool at_end() const { return at_ >= bytes_.size(); }
  std::string_view next() {
    if (at_end()) refuse("the file ends within a function");
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    const std::string_view line(bytes_.data() + at_, end - at_);
    at_ = end + 1;
    ++line_;
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }
  std::string_view raw(const std::size_t n_bytes) {
    if (n_bytes > bytes_.size() - std::min(at_, bytes_.size()))
      refuse("the file ends within the values of a function");
    at_ += n_bytes;
    return {bytes_.data() + at_ - n_bytes, n_bytes};
  }
  [[noreturn]] void refuse(const std::string& reason) const {
    throw UserError(name_ + ":" + std::to_string(line_) + ": " + reason);
  }

 private:
  const std::string& bytes_;
  const std::string& name_;
  std::size_t at_ = 0, line_ = 0;
};

// Fortran writes 1.0D-03 and, where the exponent needs three digits, 1.0-103.
std::optional<double> fortran_number(std::string field) {
  if (field.empty()) return 0.;
  std::replace_if(
      field.begin(), field.end(), [](const char c) { return c == 'D' || c == 'd'; }, 'E');
  const auto sign = field.find_last_of("+-");
  if (sign != std::string::npos && sign > 0 && field[sign - 1] != 'E' && field[sign - 1] != 'e') {
    const std::string exponent = field.substr(sign);
    field.resize(sign);
    field.append(1, 'E').append(exponent);
  }
  return to_number(field);
}

std::optional<int> whole_number(const std::string_view field) {
  if (field.empty()) return 0;
  const std::optional<double> value = to_number(field);
  constexpr double most = 2147483647.;
  if (!value || *value != std::floor(*value) || std::abs(*value) > most) return {};
  return static_cast<int>(*value);
}

std::vector<std::string_view> words_of(const std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(" \t"); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(" \t", end);
  }
  return words;
}

/// Fixed-width fields of a line.
class Fields {
 public:
  Fields(const std::string_view line, const Lines& lines) : line_(line), lines_(lines) {}

  std::string_view text(const std::size_t width) {
    const std::size_t from = std::min(at_, line_.size());
    at_ += width;
    return trimmed(line_.substr(from, width));
  }
  int whole(const std::size_t width) {
    const std::string_view field = text(width);
    const std::optional<int> value = whole_number(field);
    if (!value) lines_.refuse("'" + as_utf_8(field) + "' is not a whole number");
    return *value;
  }
  double real(const std::size_t width) {
    const std::string field(text(width));
    const std::optional<double> value = fortran_number(field);
    if (!value) lines_.refuse("'" + as_utf_8(field.substr(0, 40)) + "' is not a number");
    return *value;
  }
  void skip(const std::size_t width) { at_ += width; }
  bool has_more() const { return !trimmed(line_.substr(std::min(at_, line_.size()))).empty(); }

 private:
  std::string_view line_;
  const Lines& lines_;
  std::size_t at_ = 0;
};

Uff58Axis read_axis(Lines& lines) {
  Fields fields(lines.next(), lines);
  Uff58Axis axis;
  axis.quantity = fields.whole(10);
  axis.length_exponent = fields.whole(5);
  axis.force_exponent = fields.whole(5);
  axis.temperature_exponent = fields.whole(5);
  fields.skip(1);
  axis.label = as_utf_8(fields.text(20));
  fields.skip(1);
  axis.unit = as_utf_8(fields.text(20));
  return axis;
}

/// Storage of the values of a function in the file.
struct Layout {
  int type = real_double;
  std::size_t n_points = 0;
  bool is_even = true;

  std::size_t numbers_a_point() const {
    const bool is_complex = type == complex_single || type == complex_double;
    return (is_even ? 0 : 1) + (is_complex ? 2 : 1);
  }
  bool is_single() const { return type == real_single || type == complex_single; }
};

// The function and its degrees of freedom. Some programs keep the order but not the widths.
void read_degrees_of_freedom(Lines& lines, Uff58Function& function) {
  const std::string_view line = lines.next();
  const auto words = words_of(line);
  const auto whole = [&](const std::size_t i) { return whole_number(words[i]); };
  if (words.size() == 10 && whole(0) && whole(5) && whole(6) && whole(8) && whole(9)) {
    function.function_type = *whole(0);
    function.response_node = *whole(5);
    function.response_direction = *whole(6);
    function.reference_node = *whole(8);
    function.reference_direction = *whole(9);
    return;
  }
  Fields sixth(line, lines);
  function.function_type = sixth.whole(5);
  sixth.skip(10 + 5 + 10 + 1 + 10);
  function.response_node = sixth.whole(10);
  function.response_direction = sixth.whole(4);
  sixth.skip(1 + 10);
  function.reference_node = sixth.whole(10);
  function.reference_direction = sixth.whole(4);
}

Layout read_head(Lines& lines, Uff58Function& function) {
  for (std::string& line : function.id_lines) line = as_utf_8(trimmed(lines.next()));
  read_degrees_of_freedom(lines, function);
  Fields seventh(lines.next(), lines);
  Layout layout;
  layout.type = seventh.whole(10);
  const int n_points = seventh.whole(10);
  layout.is_even = seventh.whole(10) != 0;
  function.abscissa_start = seventh.real(13);
  function.abscissa_step = seventh.real(13);
  if (layout.type != real_single && layout.type != real_double && layout.type != complex_single &&
      layout.type != complex_double)
    lines.refuse(
        "ordinate data type " + std::to_string(layout.type) +
        " is not supported; use 2, 4, 5 or 6 (real or complex, single or double precision)");
  if (n_points < 0 || std::size_t(n_points) > most_numbers / 3)
    lines.refuse("the number of points " + std::to_string(n_points) + " is not possible");
  layout.n_points = static_cast<std::size_t>(n_points);
  function.is_complex = layout.type == complex_single || layout.type == complex_double;
  function.single_precision = layout.is_single();
  function.abscissa_axis = read_axis(lines);
  function.ordinate_axis = read_axis(lines);
  function.denominator_axis = read_axis(lines);
  lines.next();  // z axis
  return layout;
}

// The numbers of a line that blanks separate; nothing where one is no number or they fill less than
// whole points, because fixed fields touch each other there.
std::optional<std::vector<double>> separated_numbers(const std::string_view line,
                                                     const std::size_t a_point) {
  std::vector<double> numbers;
  for (const std::string_view word : words_of(line)) {
    const auto number = fortran_number(std::string(word));
    if (!number) return {};
    numbers.push_back(*number);
  }
  if (numbers.empty() || numbers.size() % a_point != 0) return {};
  return numbers;
}

// Values are E13.5 in single precision and E20.12 in double; an abscissa is E13.5, but some
// programs write it wider. The declared number of points is believed: what is behind them fills the
// line.
std::vector<double> read_text_values(Lines& lines, const Layout& layout) {
  const std::size_t a_point = layout.numbers_a_point(), count = layout.n_points * a_point;
  constexpr std::size_t narrow = 13;
  const std::size_t width = layout.is_single() ? narrow : 20;
  std::vector<double> values;
  values.reserve(std::min<std::size_t>(count, 1 << 20));
  while (values.size() < count) {
    const std::string_view line = lines.next();
    if (const auto numbers = separated_numbers(line, a_point)) {
      const std::size_t n = std::min(numbers->size(), count - values.size());
      values.insert(values.end(), numbers->begin(), numbers->begin() + std::ptrdiff_t(n));
      continue;
    }
    Fields fields(line, lines);
    if (!fields.has_more()) lines.refuse("a line of values is empty");
    while (values.size() < count && fields.has_more()) {
      const bool is_abscissa = !layout.is_even && values.size() % a_point == 0;
      values.push_back(fields.real(is_abscissa ? narrow : width));
    }
  }
  return values;
}

// The format defines an abscissa of single precision; some programs write it with the precision of
// the values.
std::vector<double> read_binary_values(Lines& lines, const Layout& layout, const std::endian order,
                                       const std::size_t n_bytes) {
  const std::size_t size = layout.is_single() ? sizeof(float) : sizeof(double);
  const std::size_t a_point = layout.numbers_a_point();
  const std::size_t narrow_bytes = layout.n_points * (sizeof(float) + (a_point - 1) * size);
  const bool has_narrow_abscissa = !layout.is_even && n_bytes == narrow_bytes;
  if (!has_narrow_abscissa && layout.n_points * a_point * size != n_bytes)
    lines.refuse("its " + std::to_string(layout.n_points) + " points do not need the " +
                 std::to_string(n_bytes) + " bytes that its first line declares");
  const std::string_view raw = lines.raw(n_bytes);
  std::vector<double> values;
  for (std::size_t at = 0; at < n_bytes;) {
    const bool is_single =
        layout.is_single() || (has_narrow_abscissa && values.size() % a_point == 0);
    const char* const from = raw.data() + at;
    values.push_back(is_single ? double(number_at<float>(from, order))
                               : number_at<double>(from, order));
    at += is_single ? sizeof(float) : sizeof(double);
  }
  return values;
}

void set_values(const std::vector<double>& numbers, const Layout& layout, Uff58Function& function) {
  const std::size_t stride = layout.numbers_a_point();
  for (std::size_t i = 0; i < layout.n_points; ++i) {
    const double* const point = numbers.data() + i * stride + (layout.is_even ? 0 : 1);
    if (!layout.is_even) function.abscissa.push_back(numbers[i * stride]);
    function.values.emplace_back(point[0], function.is_complex ? point[1] : 0.);
  }
}

Uff58Function read_function(Lines& lines, const std::string_view kind_line) {
  Uff58Function function;
  Fields kind(kind_line, lines);
  kind.skip(6);
  const bool is_binary = kind.text(1) == "b";
  const int byte_order = is_binary ? kind.whole(6) : 0;
  const int floating_format = is_binary ? kind.whole(6) : 0;
  if (is_binary) kind.skip(12);
  const int n_bytes = is_binary ? kind.whole(12) : 0;
  if (is_binary && (floating_format != 2 || byte_order < 1 || byte_order > 2 || n_bytes < 0))
    lines.refuse("its binary numbers are not in the IEEE 754 format");
  const std::endian order = byte_order == 2 ? std::endian::big : std::endian::little;
  const Layout layout = read_head(lines, function);
  set_values(is_binary ? read_binary_values(lines, layout, order, std::size_t(n_bytes))
                       : read_text_values(lines, layout),
             layout, function);
  return function;
}

void skip_data_set(Lines& lines) {
  while (!lines.at_end())
    if (lines.next().starts_with(delimiter)) return;
}

}  // namespace

std::vector<Uff58Function> parse_uff58(const std::string& bytes, const std::string& name) {
  Lines lines(bytes, name);
  std::vector<Uff58Function> functions;
  while (!lines.at_end()) {
    if (!lines.next().starts_with(delimiter) || lines.at_end()) continue;
    const std::string_view kind = lines.next();
    if (kind.starts_with("    58")) functions.push_back(read_function(lines, kind));
    skip_data_set(lines);
  }
  if (functions.empty())
    throw UserError(name + ": contains no function of type 58 of the Universal File Format");
  return functions;
}

std::vector<Uff58Function> read_uff58(const std::filesystem::path& file) {
  return parse_uff58(read_bytes(file), file.string());
}

}  // namespace vibrissa::signals::formats
