#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::signals {

/// An HDF5 file in memory, of arrays of doubles and texts under paths such as "vectors/velocity";
/// any HDF5 tool reads it. Proven by tests/fem/motion/checkpoint_test.cc and
/// tests/apps/exchange.py.
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();
  void add(const std::string& path, std::span<const double> values);
  void add(const std::string& path, const std::string& text);
  /// A text that belongs to the whole file.
  void describe(const std::string& attribute, const std::string& text);
  /// The whole file. It may stand behind a block of 512 bytes of the writer's own: HDF5 looks for
  /// its beginning there, too.
  std::string image();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reads such an image. Throws std::runtime_error that names the path when it is not there, has
/// another kind, or the image is damaged.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& image);
  ~Hdf5Reader();
  std::vector<double> numbers(const std::string& path) const;
  std::string text(const std::string& path) const;
  bool has(const std::string& path) const;  // at the top
  /// What a group holds, in alphabetical order.
  std::vector<std::string> names(const std::string& group) const;

  /// An array of real numbers anywhere in the file.
  struct Array {
    std::string path;
    std::vector<std::size_t> shape;  // empty: one number
    bool single_precision = false;
    std::size_t size() const;  // saturates
  };
  /// All of them, in alphabetical order of their paths; other kinds are left out.
  std::vector<Array> arrays() const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace vibrissa::signals
