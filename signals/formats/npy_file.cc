#include "signals/formats/npy_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <ostream>
#include <regex>
#include <span>
#include <string_view>

#include "signals/base/error.h"
#include "signals/formats/matrix_columns.h"
#include "signals/formats/number_bytes.h"
#include "signals/formats/record_columns.h"
#include "signals/record/channel_name.h"
#include "signals/system/file_bytes.h"
#include "signals/system/output_file.h"

namespace vibrissa::signals::formats {
namespace {

const std::string magic = "\x93NUMPY";

[[noreturn]] void refuse(const std::string& name, const std::string& reason) {
  throw UserError(name + ": " + reason);
}

// One number as NumPy describes it: "<f8".
struct NumberType {
  std::endian order = std::endian::native;
  char kind = 'f';  // f, i or u
  std::size_t size = 8;
};

struct Field {
  std::string name;  // empty: of a plain array
  NumberType type;
};

struct Header {
  std::vector<Field> fields;
  std::vector<std::size_t> shape;
  bool fortran_order = false;
  std::size_t data_at = 0;

  std::size_t row_size() const {
    std::size_t size = 0;
    for (const Field& field : fields) size += field.type.size;
    return size;
  }
};

NumberType type_of(const std::string& text, const std::string& name) {
  static const std::regex form("([<>|=]?)([fiu])([1248])");
  std::smatch found;
  if (!std::regex_match(text, found, form) || found.str(2) + found.str(3) == "f1" ||
      found.str(2) + found.str(3) == "f2")
    refuse(name, "contains numbers of type '" + text.substr(0, 20) +
                     "'; columns need real numbers (f4, f8, i1 to i8, u1 to u8)");
  const std::endian order = found.str(1) == ">"   ? std::endian::big
                            : found.str(1) == "<" ? std::endian::little
                                                  : std::endian::native;
  return {order, found.str(2)[0], static_cast<std::size_t>(found.str(3)[0] - '0')};
}

// The value of an entry of the header, which is a dictionary as Python prints it.
std::string entry(const std::string& header, const std::string& key, const std::string& name) {
  const auto at = header.find("'" + key + "':");
  if (at == std::string::npos) refuse(name, "its header has no entry '" + key + "'");
  const auto first = header.find_first_not_of(' ', at + key.size() + 3);
  return first == std::string::npos ? std::string() : header.substr(first);
}

std::vector<std::size_t> shape_of(const std::string& text, const std::string& name) {
  if (!text.starts_with('(') || text.find(')') == std::string::npos)
    refuse(name, "its header has no shape");
  std::vector<std::size_t> shape;
  std::size_t value = 0;
  bool has_digit = false;
  for (std::size_t i = 1;; ++i) {
    const char c = text[i];
    if (c >= '0' && c <= '9') {
      has_digit = true;
      value = std::min(10 * value + static_cast<std::size_t>(c - '0'), 2 * most_numbers);
    } else if (c == ',' || c == ')') {
      if (has_digit) shape.push_back(value);
      value = 0;
      has_digit = false;
      if (c == ')') return shape;
    } else if (c != ' ' && c != 'L') {
      refuse(name, "its header has no shape");
    }
  }
}

std::vector<Field> fields_of(const std::string& text, const std::string& name) {
  if (text.starts_with('\'')) {
    const auto end = text.find('\'', 1);
    if (end == std::string::npos) refuse(name, "its header has no type");
    return {{"", type_of(text.substr(1, end - 1), name)}};
  }
  const auto end = text.find(']');
  if (!text.starts_with('[') || end == std::string::npos) refuse(name, "its header has no type");
  const std::string list = text.substr(0, end);
  static const std::regex pair("\\('([^']*)', *'([^']*)'\\)");
  std::vector<Field> fields;
  for (std::sregex_iterator found(list.begin(), list.end(), pair), none; found != none; ++found)
    fields.push_back({found->str(1), type_of(found->str(2), name)});
  const auto n_open = static_cast<std::size_t>(std::count(list.begin(), list.end(), '('));
  if (fields.empty() || fields.size() != n_open)
    refuse(name, "each of its fields must be a single real number");
  return fields;
}

Header read_header(const std::string& bytes, const std::string& name) {
  if (!bytes.starts_with(magic) || bytes.size() < 12)
    refuse(name, "is not a NumPy array file (it does not begin with \\x93NUMPY)");
  const int version = bytes[6];
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;)
    length = 256 * length + static_cast<unsigned char>(bytes[8 + i]);
  const std::size_t at = 8 + length_bytes;
  constexpr std::size_t longest_header = 1 << 16;
  if (version < 1 || version > 3 || length > longest_header || length > bytes.size() - at)
    refuse(name, "its header is damaged");
  const std::string text = bytes.substr(at, length);
  return {fields_of(entry(text, "descr", name), name), shape_of(entry(text, "shape", name), name),
          entry(text, "fortran_order", name).starts_with("True"), at + length};
}

double value_at(const char* const from, const NumberType& type) {
  const std::endian order = type.order;
  if (type.kind == 'f')
    return type.size == 4 ? double(number_at<float>(from, order)) : number_at<double>(from, order);
  const bool is_signed = type.kind == 'i';
  switch (type.size) {
    case 1:
      return is_signed ? double(number_at<std::int8_t>(from, order))
                       : double(number_at<std::uint8_t>(from, order));
    case 2:
      return is_signed ? double(number_at<std::int16_t>(from, order))
                       : double(number_at<std::uint16_t>(from, order));
    case 4:
      return is_signed ? double(number_at<std::int32_t>(from, order))
                       : double(number_at<std::uint32_t>(from, order));
    default:
      return is_signed ? double(number_at<std::int64_t>(from, order))
                       : double(number_at<std::uint64_t>(from, order));
  }
}

std::size_t checked_count(const Header& header, const std::size_t n_bytes,
                          const std::string& name) {
  std::size_t count = 1;
  for (const std::size_t length : header.shape)
    if (__builtin_mul_overflow(count, length, &count) || count > most_numbers)
      refuse(name, "declares more than " + std::to_string(most_numbers) +
                       " numbers, the most that are read from one file");
  if (count * header.row_size() != n_bytes)
    refuse(name, "its header declares " + std::to_string(count * header.row_size()) +
                     " bytes of data, but the file has " + std::to_string(n_bytes));
  return count;
}

std::vector<double> field_values(const std::string& bytes, const Header& header,
                                 const std::size_t offset, const NumberType& type,
                                 const std::size_t count) {
  std::vector<double> values(count);
  const std::size_t row_size = header.row_size();
  for (std::size_t i = 0; i < count; ++i)
    values[i] = value_at(bytes.data() + header.data_at + i * row_size + offset, type);
  return values;
}

}  // namespace

std::unique_ptr<RecordTable> parse_npy(const std::string& bytes, const std::string& name) {
  const Header header = read_header(bytes, name);
  const std::size_t count = checked_count(header, bytes.size() - header.data_at, name);
  std::vector<NumericColumn> columns;
  std::size_t offset = 0;
  for (const Field& field : header.fields) {
    const bool single = field.type.kind == 'f' && field.type.size == 4;
    auto values = field_values(bytes, header, offset, field.type, count);
    offset += field.type.size;
    if (!field.name.empty()) {
      columns.push_back({field.name, std::move(values), single});
      continue;
    }
    columns = columns_of({"column", header.shape, std::move(values), single, header.fortran_order});
    if (columns.size() == 1) columns.front().name = "column_1";
  }
  return std::make_unique<NumericTable>(name, std::move(columns));
}

std::unique_ptr<RecordTable> read_npy(const std::filesystem::path& file) {
  return parse_npy(read_bytes(file), file.string());
}

namespace {

std::string npy_header(const std::vector<std::string>& names, const std::size_t n_rows) {
  std::string header = "{'descr': [";
  for (const std::string& name : names) header.append("('").append(name).append("', '<f8'), ");
  header += "], 'fortran_order': False, 'shape': (" + std::to_string(n_rows) + ",), }";
  constexpr std::size_t alignment = 64, before = 10;
  header.resize((before + header.size() + alignment) / alignment * alignment - before, ' ');
  header.back() = '\n';
  std::string bytes = magic;
  bytes +=
      {'\1', '\0', static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
  return bytes + header;
}

}  // namespace

// Row by row, so that no second copy of a long record is held.
void write_npy(const std::filesystem::path& file, const Record& record) {
  std::vector<std::string> names{time_channel};
  std::vector<std::span<const double>> columns;
  for (const std::string& name : channels_in_writing_order(record)) {
    names.push_back(name);
    columns.push_back(record.channel(name));
  }
  static_assert(std::endian::native == std::endian::little);
  write_file(file, [&](std::ostream& out) {
    out << npy_header(names, record.n_samples());
    std::vector<double> row(names.size());
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      row[0] = record.time_s(i);
      for (std::size_t c = 0; c < columns.size(); ++c) row[c + 1] = columns[c][i];
      out.write(reinterpret_cast<const char*>(row.data()),
                static_cast<std::streamsize>(row.size() * sizeof(double)));
    }
  });
}

}  // namespace vibrissa::signals::formats
