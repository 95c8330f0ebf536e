#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <vector>

namespace vibrissa::report {

/// Lists of numbers in a compact lossless form; equal lists are stored once. Proven
/// by tests/report/figures/packed_numbers_test.cc.
class PackedNumbers {
 public:
  /// The index of the list in json().
  std::size_t add(const std::vector<double>& values);

  /// One entry per list, in the shortest form that holds the values exactly:
  /// {"n", "first", "rate"}: first + i / rate; {"f32"} and {"f64"}: little-endian bytes in base64.
  const nlohmann::json& json() const { return lists_; }

 private:
  nlohmann::json lists_ = nlohmann::json::array();
  std::unordered_map<std::string, std::size_t> known_;  // text of the entry -> its number
};

}  // namespace vibrissa::report
