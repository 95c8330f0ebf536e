#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::signals {

/// Writes an HDF5 file in memory, with arrays of doubles and texts at paths such as
/// "vectors/velocity". Every HDF5 tool can read it. Proven by tests/fem/motion/checkpoint_test.cc
/// and tests/apps/exchange.py.
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();
  void add(const std::string& path, std::span<const double> values);
  void add(const std::string& path, const std::string& text);
  /// Adds a text that describes the whole file.
  void describe(const std::string& attribute, const std::string& text);
  /// Adds a text that describes an array.
  void describe(const std::string& path, const std::string& attribute, const std::string& text);
  /// Bytes of the whole file. A block of 512 other bytes may precede them: HDF5 also searches for
  /// the start there.
  std::string image();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reads an HDF5 file in memory. Throws std::runtime_error with the path when it does not exist,
/// has another type, or the file is damaged.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& image);
  ~Hdf5Reader();
  std::vector<double> numbers(const std::string& path) const;
  std::string text(const std::string& path) const;
  bool has(const std::string& path) const;  // at the top level
  /// Names of the members of a group, in alphabetical order.
  std::vector<std::string> names(const std::string& group) const;

  /// An array of real numbers anywhere in the file.
  struct Array {
    std::string path;
    std::vector<std::size_t> shape;  // empty: one number
    bool single_precision = false;
    std::string unit = {};     // of its attribute unit or units; empty: none
    std::size_t size() const;  // saturates
  };
  /// All arrays of real numbers, in alphabetical order of their paths.
  std::vector<Array> arrays() const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace vibrissa::signals
