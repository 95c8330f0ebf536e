#include "signals/formats/mat_file.h"

#include <matio.h>
#include <array>
#include <complex>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>

#include "signals/base/error.h"
#include "signals/formats/hdf5_image.h"
#include "signals/formats/matrix_columns.h"
#include "signals/formats/number_bytes.h"
#include "signals/formats/record_columns.h"
#include "signals/system/file_bytes.h"
#include "signals/system/rehearsal.h"

namespace vibrissa::signals::formats {
namespace {

struct Close {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, Close>;
using Variable = std::unique_ptr<matvar_t, Close>;

std::size_t n_values(const matvar_t& variable) {
  std::size_t n = 1;
  for (int i = 0; i < variable.rank; ++i)
    if (__builtin_mul_overflow(n, variable.dims[i], &n))
      return std::numeric_limits<std::size_t>::max();
  return n;
}

template <typename Number>
std::vector<double> numbers(const void* const data, const std::size_t n) {
  const auto* const first = static_cast<const Number*>(data);
  return {first, first + n};
}

std::vector<double> values_of(const matvar_t& variable, const void* const data) {
  const std::size_t n = n_values(variable);
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return numbers<double>(data, n);
    case MAT_C_SINGLE:
      return numbers<float>(data, n);
    case MAT_C_INT8:
      return numbers<std::int8_t>(data, n);
    case MAT_C_UINT8:
      return numbers<std::uint8_t>(data, n);
    case MAT_C_INT16:
      return numbers<std::int16_t>(data, n);
    case MAT_C_UINT16:
      return numbers<std::uint16_t>(data, n);
    case MAT_C_INT32:
      return numbers<std::int32_t>(data, n);
    case MAT_C_UINT32:
      return numbers<std::uint32_t>(data, n);
    case MAT_C_INT64:
      return numbers<std::int64_t>(data, n);
    case MAT_C_UINT64:
      return numbers<std::uint64_t>(data, n);
    default:
      return {};
  }
}

bool is_array(const matvar_t& variable) {
  return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
}

// A complex array gives two real arrays.
std::vector<NamedArray> arrays_of(const matvar_t& variable, const std::string& name) {
  const std::vector<std::size_t> shape(variable.dims, variable.dims + variable.rank);
  const bool is_single = variable.class_type == MAT_C_SINGLE;
  if (variable.isComplex == 0)
    return {{name, shape, values_of(variable, variable.data), is_single}};
  const auto* const parts = static_cast<const mat_complex_split_t*>(variable.data);
  return {{name + "_real", shape, values_of(variable, parts->Re), is_single},
          {name + "_imaginary", shape, values_of(variable, parts->Im), is_single}};
}

void add_columns(const matvar_t& variable, const std::string& name,
                 std::vector<NumericColumn>& columns);

// "bench.ax"; of an array of structs "bench(2).ax".
void add_fields(const matvar_t& variable, const std::string& name,
                std::vector<NumericColumn>& columns) {
  // The function of matio takes no const pointer.
  auto& fields = const_cast<matvar_t&>(variable);
  const unsigned n_fields = Mat_VarGetNumberOfFields(&fields);
  char* const* const names = Mat_VarGetStructFieldnames(&variable);
  const std::size_t n = n_values(variable);
  for (std::size_t k = 0; k < n; ++k) {
    const std::string element = n == 1 ? name : name + "(" + std::to_string(k + 1) + ")";
    for (unsigned i = 0; i < n_fields; ++i) {
      const matvar_t* const field = Mat_VarGetStructFieldByIndex(&fields, i, k);
      if (field != nullptr) add_columns(*field, element + "." + names[i], columns);
    }
  }
}

void add_columns(const matvar_t& variable, const std::string& name,
                 std::vector<NumericColumn>& columns) {
  if (variable.class_type == MAT_C_STRUCT) return add_fields(variable, name, columns);
  if (!is_array(variable) || variable.data == nullptr || n_values(variable) == 0) return;
  for (NamedArray& array : arrays_of(variable, name))
    for (NumericColumn& column : columns_of(std::move(array))) columns.push_back(std::move(column));
}

// Declared number of values of a variable with all its fields.
std::size_t claimed(const matvar_t& variable) {
  const std::size_t n = n_values(variable);
  if (variable.class_type != MAT_C_STRUCT || n > most_numbers) return n;
  auto& fields = const_cast<matvar_t&>(variable);
  const unsigned n_fields = Mat_VarGetNumberOfFields(&fields);
  std::size_t sum = n;
  for (std::size_t k = 0; k < n; ++k)
    for (unsigned i = 0; i < n_fields; ++i)
      if (const auto* const field = Mat_VarGetStructFieldByIndex(&fields, i, k))
        if (__builtin_add_overflow(sum, claimed(*field), &sum))
          return std::numeric_limits<std::size_t>::max();
  return sum;
}

void check_claims(mat_t* const file, const std::size_t n_bytes, const std::string& name) {
  // A number has at least one byte.
  const std::size_t most = std::min(most_numbers, largest_expansion * n_bytes);
  std::size_t left = most;
  while (const Variable variable{Mat_VarReadNextInfo(file)}) {
    const std::size_t n = claimed(*variable);
    if (n > left)
      throw UserError(name + ": variable '" + (variable->name ? variable->name : "") +
                      "' declares " + std::to_string(n) + " numbers; at most " +
                      std::to_string(most) + " are read from a file of this size");
    left -= n;
  }
}

// matio can write only to a file name: a temporary folder is used first.
class ScratchFile {
 public:
  ScratchFile() {
    std::string name = (std::filesystem::temp_directory_path() / "vibrissa-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw ResourceError(
          name +
          ": this temporary folder cannot be created; set TMPDIR to a folder that can be written");
    folder_ = name;
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  std::string name() const { return (folder_ / "unfinished.mat").string(); }

 private:
  std::filesystem::path folder_;
};

constexpr std::size_t header_size = 128;

struct MatHeader {
  unsigned version = 0;  // 0x0100: 5, 0x0200: 7.3
  std::endian order = std::endian::native;
};

// Version 4 has none.
std::optional<MatHeader> header_of(const std::string& bytes) {
  constexpr std::size_t version_at = 124, order_at = 126;
  if (bytes.size() < header_size) return std::nullopt;
  const std::string mark = bytes.substr(order_at, 2);
  if (mark != "MI" && mark != "IM") return std::nullopt;
  const std::endian order = mark == "MI" ? std::endian::big : std::endian::little;
  return MatHeader{number_at<std::uint16_t>(&bytes[version_at], order), order};
}

// The elements of a version 5 file fill it to its last byte; matio reads a truncated file without
// an error, and does not notice a full disk.
void check_is_whole(const std::string& bytes, const std::string& name) {
  constexpr std::size_t tag = 8;
  const auto header = header_of(bytes);
  if (!header || header->version != 0x0100) return;
  std::size_t at = header_size;
  while (at + tag <= bytes.size())
    at += tag + number_at<std::uint32_t>(&bytes[at + 4], header->order);
  if (at != bytes.size())
    throw UserError(name + ": is damaged: its last variable does not end at the end of the file");
}

// matio allocates the size that the headers of a version 4 file declare before it notices that the
// file is shorter.
void check_version_4(const std::string& bytes, const std::string& name) {
  constexpr std::size_t header = 20;
  constexpr std::uint32_t largest_type = 4052;
  constexpr std::array<double, 6> widths{8., 4., 4., 2., 2., 1.};
  double at = 0.;  // sums of what is claimed do not overflow
  const double end = static_cast<double>(bytes.size());
  const bool little = bytes.size() < header ||
                      number_at<std::uint32_t>(bytes.data(), std::endian::little) <= largest_type;
  const std::endian order = little ? std::endian::little : std::endian::big;
  while (at + header <= end) {
    std::array<double, 5> head{};  // type, rows, columns, is complex, length of the name
    for (std::size_t i = 0; i < head.size(); ++i)
      head[i] = number_at<std::uint32_t>(&bytes[static_cast<std::size_t>(at) + 4 * i], order);
    const std::size_t precision = static_cast<std::size_t>(head[0]) / 10 % 10;
    if (precision >= widths.size()) break;
    at += header + head[4] + head[1] * head[2] * widths[precision] * (head[3] != 0. ? 2. : 1.);
  }
  if (at != end) throw UserError(name + ": cannot be read as a MATLAB file (version 4, 5 or 7.3)");
}

void check_version_73(const std::string& bytes, const std::string& name) {
  try {
    Hdf5Reader(bytes).arrays();
  } catch (const std::runtime_error& error) {
    throw UserError(name + ": cannot be read as a MATLAB file of version 7.3: " + error.what());
  }
}

void check_size(const std::string& bytes, const std::string& name) {
  const auto header = header_of(bytes);
  if (!header) return check_version_4(bytes, name);
  if (header->version >> 8 == 2) return check_version_73(bytes, name);
  check_is_whole(bytes, name);
}

// The bytes are those of the file of that name.
std::vector<NumericColumn> all_columns(const std::string& bytes, const std::string& name) {
  check_size(bytes, name);
  const MatFile opened(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
  if (!opened) throw UserError(name + ": cannot be read as a MATLAB file (version 4, 5 or 7.3)");
  check_claims(opened.get(), bytes.size(), name);
  Mat_Rewind(opened.get());
  std::vector<NumericColumn> columns;
  while (const Variable variable{Mat_VarReadNext(opened.get())})
    if (variable->name != nullptr) add_columns(*variable, variable->name, columns);
  return columns;
}

void put(mat_t* const file, const std::string& name, const Variable& variable) {
  if (!variable || Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_NONE) != 0)
    throw InternalError("'" + name + "' cannot be written as a MATLAB variable");
}

// matio only reads this data, although its parameter is not const.
void* readable(const void* const data) {
  return const_cast<void*>(data);
}

void add(mat_t* const file, const std::string& name, const std::span<const double> values) {
  std::array<std::size_t, 2> shape{values.size(), 1};
  put(file, name,
      Variable(Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape.data(),
                             readable(values.data()), MAT_F_DONT_COPY_DATA)));
}

void add(mat_t* const file, const std::string& name,
         const std::span<const std::complex<double>> values) {
  std::vector<double> real, imaginary;
  for (const auto& value : values) {
    real.push_back(value.real());
    imaginary.push_back(value.imag());
  }
  mat_complex_split_t parts{real.data(), imaginary.data()};
  std::array<std::size_t, 2> shape{values.size(), 1};
  put(file, name,
      Variable(Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape.data(), &parts,
                             MAT_F_COMPLEX | MAT_F_DONT_COPY_DATA)));
}

void add(mat_t* const file, const std::string& name, const std::string& text) {
  std::array<std::size_t, 2> shape{1, text.size()};
  put(file, name,
      Variable(Mat_VarCreate(name.c_str(), MAT_C_CHAR, MAT_T_UTF8, 2, shape.data(),
                             readable(text.data()), MAT_F_DONT_COPY_DATA)));
}

/// Writes a temporary file, and checks that it is complete and has at least the size that `fill`
/// returns.
void write_aside(const std::filesystem::path& file, const bool is_v5,
                 const std::function<std::size_t(mat_t*)>& fill) {
  const ScratchFile scratch;
  std::size_t least_bytes = 0;
  {
    // Own header, because the default header of matio contains the time: equal records must give
    // equal files.
    const char* const header = is_v5 ? "MATLAB 5.0 MAT-file, written by vibrissa"
                                     : "MATLAB 7.3 MAT-file, written by vibrissa";
    const MatFile made(
        Mat_CreateVer(scratch.name().c_str(), header, is_v5 ? MAT_FT_MAT5 : MAT_FT_MAT73));
    if (!made) throw ResourceError(scratch.name() + ": cannot be written");
    least_bytes = fill(made.get());
  }
  const std::string bytes = read_bytes(scratch.name());
  check_is_whole(bytes, scratch.name());
  // On a full disk matio may also omit values and close the file without an error.
  if (bytes.size() < least_bytes)
    throw ResourceError(scratch.name() + ": only " + std::to_string(bytes.size()) +
                        " bytes of a MATLAB file could be written; free disk space, or set TMPDIR "
                        "to a folder with more space");
  write_bytes(file, bytes);
}

}  // namespace

std::unique_ptr<RecordTable> read_mat(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string bytes = read_bytes(file);
  const auto read = [&] { return all_columns(bytes, name); };
  rehearse(name, bytes.size(), read);
  return std::make_unique<NumericTable>(name, read());
}

void write_mat(const std::filesystem::path& file, const Record& record, const MatVersion version) {
  constexpr std::size_t most_in_v5 = (std::size_t{1} << 31) / sizeof(double) - 16;
  const bool is_v5 = version == MatVersion::v5 && record.n_samples() < most_in_v5;
  write_aside(file, is_v5, [&](mat_t* const made) {
    std::size_t n_bytes = 0;
    for_each_array(record, [&](const std::string& name, const std::span<const double> values) {
      add(made, name, values);
      n_bytes += values.size_bytes();
    });
    return n_bytes;
  });
}

void write_mat(const std::filesystem::path& file, const FrequencyResponse& response,
               const std::string& convention) {
  write_aside(file, true, [&](mat_t* const made) {
    add(made, "convention", convention);
    add(made, "frequency_hz", response.frequency_hz);
    add(made, "response", std::span<const std::complex<double>>(response.value));
    if (!response.coherence.empty()) add(made, "coherence", response.coherence);
    if (!response.standard_deviation.empty())
      add(made, "standard_deviation", response.standard_deviation);
    return (response.frequency_hz.size() + 2 * response.value.size()) * sizeof(double);
  });
}

}  // namespace vibrissa::signals::formats
