#include "signals/formats/hdf5_image.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "signals/system/file_bytes.h"

namespace vibrissa::signals {

namespace {

/// A handle of the library, closed at the end of its lifetime.
class Handle {
 public:
  Handle(const hid_t id, herr_t (*const close)(hid_t), const std::string& what)
      : id_(id), close_(close) {
    if (id_ < 0) throw std::runtime_error("HDF5 cannot " + what);
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(const herr_t status, const std::string& what) {
  if (status < 0) throw std::runtime_error("HDF5 cannot " + what);
}

/// Turns off the error output of the library on the terminal: exceptions replace it.
void silence_library() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Handle in_memory() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make a file's properties");
  constexpr std::size_t grow_by = 1 << 20;
  require(H5Pset_fapl_core(access, grow_by, false), "keep a file in memory");
  return access;
}

Handle create_file() {
  silence_library();
  return {H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, in_memory()), H5Fclose, "make a file"};
}

Handle open_file(const std::string& image) {
  silence_library();
  const Handle access = in_memory();
  // The library copies the image, although its parameter is not const.
  require(H5Pset_file_image(access, const_cast<char*>(image.data()), image.size()),
          "open a file in memory");
  return {H5Fopen("in memory", H5F_ACC_RDONLY, access), H5Fclose, "read it: the file is damaged"};
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type");
  require(H5Tset_cset(type, H5T_CSET_UTF8), "make a type of text");
  return type;
}

void write(const hid_t file, const std::string& path, const hid_t type, const hid_t space,
           const void* const values) {
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "make a link's properties");
  require(H5Pset_create_intermediate_group(links, 1), "make groups");
  const Handle set(H5Dcreate2(file, path.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT),
                   H5Dclose, "make '" + path + "'");
  require(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write '" + path + "'");
}

std::vector<std::size_t> shape_of(const hid_t set, const std::string& path) {
  const Handle space(H5Dget_space(set), H5Sclose, "read the shape of '" + path + "'");
  const int rank = H5Sget_simple_extent_ndims(space);
  require(rank, "read the shape of '" + path + "'");
  std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
  if (rank > 0)
    require(H5Sget_simple_extent_dims(space, lengths.data(), nullptr),
            "read the shape of '" + path + "'");
  return {lengths.begin(), lengths.end()};
}

}  // namespace

struct Hdf5Writer::File {
  Handle handle = create_file();
};

Hdf5Writer::Hdf5Writer() : file_(std::make_unique<File>()) {}
Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::add(const std::string& path, const std::span<const double> values) {
  const hsize_t n = values.size();
  const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, "make a shape");
  write(file_->handle, path, H5T_NATIVE_DOUBLE, space, values.data());
}

void Hdf5Writer::add(const std::string& path, const std::string& text) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a shape");
  const Handle type = text_type();
  require(H5Tset_size(type, text.size() + 1), "make a type of text");
  write(file_->handle, path, type, space, text.c_str());
}

namespace {

void attach(const hid_t object, const std::string& attribute, const std::string& text) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a shape");
  const Handle type = text_type();
  require(H5Tset_size(type, text.size() + 1), "make a type of text");
  const Handle made(H5Acreate2(object, attribute.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose, "make '" + attribute + "'");
  require(H5Awrite(made, type, text.c_str()), "write '" + attribute + "'");
}

}  // namespace

void Hdf5Writer::describe(const std::string& attribute, const std::string& text) {
  attach(file_->handle, attribute, text);
}

void Hdf5Writer::describe(const std::string& path, const std::string& attribute,
                          const std::string& text) {
  const Handle set(H5Dopen2(file_->handle, path.c_str(), H5P_DEFAULT), H5Dclose,
                   "find '" + path + "'");
  attach(set, attribute, text);
}

std::string Hdf5Writer::image() {
  require(H5Fflush(file_->handle, H5F_SCOPE_GLOBAL), "finish a file");
  const ssize_t size = H5Fget_file_image(file_->handle, nullptr, 0);
  if (size <= 0) throw std::runtime_error("HDF5 cannot copy the bytes of a file");
  std::string image(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file_->handle, image.data(), image.size()) != size)
    throw std::runtime_error("HDF5 cannot copy the bytes of a file");
  return image;
}

struct Hdf5Reader::File {
  explicit File(const std::string& image) : handle(open_file(image)) {}
  Handle set(const std::string& path) const {
    return {H5Dopen2(handle, path.c_str(), H5P_DEFAULT), H5Dclose, "find '" + path + "'"};
  }
  Handle handle;
};

Hdf5Reader::Hdf5Reader(const std::string& image) : file_(std::make_unique<File>(image)) {}
Hdf5Reader::~Hdf5Reader() = default;

std::vector<double> Hdf5Reader::numbers(const std::string& path) const {
  const Handle set = file_->set(path);
  const Handle space(H5Dget_space(set), H5Sclose, "read the shape of '" + path + "'");
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (n < 0) throw std::runtime_error("HDF5 cannot read the size of '" + path + "'");
  std::vector<double> values(static_cast<std::size_t>(n));
  require(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          "read numbers from '" + path + "'");
  return values;
}

std::string Hdf5Reader::text(const std::string& path) const {
  const Handle set = file_->set(path);
  const Handle type(H5Dget_type(set), H5Tclose, "read the type of '" + path + "'");
  if (H5Tget_class(type) != H5T_STRING)
    throw std::runtime_error("HDF5 cannot read a text from '" + path + "'");
  std::string text(H5Tget_size(type), '\0');
  require(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "read '" + path + "'");
  text.resize(text.find('\0'));
  return text;
}

bool Hdf5Reader::has(const std::string& path) const {
  return H5Lexists(file_->handle, path.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Reader::names(const std::string& group) const {
  const Handle opened(H5Gopen2(file_->handle, group.c_str(), H5P_DEFAULT), H5Gclose,
                      "find '" + group + "'");
  std::vector<std::string> found;
  const auto keep = [](hid_t, const char* const name, const H5L_info_t*, void* const to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  require(H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &found),
          "list '" + group + "'");
  return found;
}

namespace {

/// Saturates.
template <typename Number>
std::size_t product(const std::span<const Number> lengths) {
  std::size_t n = 1;
  for (const Number length : lengths)
    if (__builtin_mul_overflow(n, length, &n)) return std::numeric_limits<std::size_t>::max();
  return n;
}

/// Number of values in a chunk of a data set, from its creation property list.
std::size_t chunk_size(const hid_t list) {
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(list, static_cast<int>(chunk.size()), chunk.data());
  return product(
      std::span<const hsize_t>(chunk).first(static_cast<std::size_t>(std::max(rank, 0))));
}

/// Checks that the file has enough bytes for the declared n numbers of a data set, or for one of
/// its chunks. A limited amount of unwritten data (fill values) is allowed.
void check_stored(const hid_t set, const std::size_t number_size, const std::size_t n,
                  const std::string& path) {
  constexpr std::size_t most_unwritten = 1u << 20, longest_number = 16;
  if (number_size == 0 || number_size > longest_number)
    throw std::runtime_error("'" + path + "' declares numbers of " + std::to_string(number_size) +
                             " bytes");
  const std::size_t stored = H5Dget_storage_size(set);
  const Handle list(H5Dget_create_plist(set), H5Pclose, "read the layout of '" + path + "'");
  const H5D_layout_t layout = H5Pget_layout(list);
  const std::size_t claimed = layout == H5D_CHUNKED ? std::max(n, chunk_size(list)) : n;
  // The library would read beyond a data set that is shorter than its shape. Only a compact data
  // set, which is stored in its header, exists before it is written.
  const bool is_written = stored != 0 || layout == H5D_COMPACT;
  const bool is_cut = layout != H5D_CHUNKED && is_written && stored / number_size < n;
  const bool is_hollow =
      claimed > most_unwritten && claimed / largest_expansion > stored / number_size;
  if (is_cut || is_hollow)
    throw std::runtime_error("'" + path + "' declares " + std::to_string(claimed) +
                             " numbers, but has only " + std::to_string(stored) + " bytes");
}

// The text of an attribute of fixed or variable length; empty where it is none.
std::string text_attribute(const hid_t set, const char* const name) {
  constexpr std::size_t longest = 200;
  if (H5Aexists(set, name) <= 0) return {};
  const Handle attribute(H5Aopen(set, name, H5P_DEFAULT), H5Aclose, "read an attribute");
  const Handle type(H5Aget_type(attribute), H5Tclose, "read the type of an attribute");
  const Handle space(H5Aget_space(attribute), H5Sclose, "read the shape of an attribute");
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return {};
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    require(H5Aread(attribute, type, static_cast<void*>(&text)), "read an attribute");
    const std::string copy = text == nullptr ? "" : text;
    H5free_memory(text);
    return copy.substr(0, longest);
  }
  const std::size_t size = H5Tget_size(type);
  if (size > longest) return {};
  std::string text(size, '\0');
  require(H5Aread(attribute, type, text.data()), "read an attribute");
  return text.substr(0, std::min(text.find('\0'), text.size()));
}

std::string unit_attribute(const hid_t set) {
  for (const char* const name : {"units", "unit", "Units", "Unit"})
    if (std::string unit = text_attribute(set, name); !unit.empty()) return unit;
  return {};
}

}  // namespace

std::size_t Hdf5Reader::Array::size() const {
  return product(std::span<const std::size_t>(shape));
}

std::vector<Hdf5Reader::Array> Hdf5Reader::arrays() const {
  std::vector<std::string> paths;
  const auto keep = [](hid_t, const char* const name, const H5O_info_t* const info,
                       void* const to) -> herr_t {
    if (info->type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  require(H5Ovisit1(file_->handle, H5_INDEX_NAME, H5_ITER_INC, keep, &paths), "list its arrays");
  std::vector<Array> found;
  for (const std::string& path : paths) {
    const Handle set = file_->set(path);
    const Handle type(H5Dget_type(set), H5Tclose, "read the type of '" + path + "'");
    const H5T_class_t kind = H5Tget_class(type);
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) continue;
    found.push_back({path, shape_of(set, path), kind == H5T_FLOAT && H5Tget_size(type) <= 4,
                     unit_attribute(set)});
    check_stored(set, H5Tget_size(type), found.back().size(), path);
  }
  return found;
}

}  // namespace vibrissa::signals
