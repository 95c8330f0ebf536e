#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <vector>

namespace vibrissa::report {

/// Lists of numbers in a small form that loses no digit; lists that are equal are kept once. Proven
/// by tests/report/figures/packed_numbers_test.cc.
class PackedNumbers {
 public:
  /// The number of the list in json().
  std::size_t add(const std::vector<double>& values);

  /// One entry a list, as short as the values allow:
  /// {"n", "first", "rate"}: first + i / rate; {"f32"} and {"f64"}: little-endian bytes in base64.
  const nlohmann::json& json() const { return lists_; }

 private:
  nlohmann::json lists_ = nlohmann::json::array();
  std::unordered_map<std::string, std::size_t> known_;  // text of the entry -> its number
};

}  // namespace vibrissa::report
