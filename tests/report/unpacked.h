#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vibrissa::report::testing {

inline std::string bytes_of_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6 | static_cast<unsigned>(letters.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255);
  }
  return bytes;
}

template <typename Number>
std::vector<double> numbers_of(const std::string& bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return {numbers.begin(), numbers.end()};
}

/// A list of report/figures/packed_numbers.h, read as the page's script reads it.
inline std::vector<double> unpacked(const nlohmann::json& entry) {
  if (entry.contains("f64")) return numbers_of<double>(bytes_of_base64(entry["f64"]));
  if (entry.contains("f32")) return numbers_of<float>(bytes_of_base64(entry["f32"]));
  std::vector<double> list;
  for (std::size_t i = 0; i < entry["n"].get<std::size_t>(); ++i)
    list.push_back(entry["first"].get<double>() +
                   static_cast<double>(i) / entry["rate"].get<double>());
  return list;
}

}  // namespace vibrissa::report::testing
