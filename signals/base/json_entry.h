#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {

/// One value of a JSON file with its place in the file. Every reader throws UserError with the
/// file, the place and the expected type. The document must outlive it. Proven by
/// tests/signals/model/reduced_model_json_test.cc, which reads through it.
class JsonEntry {
 public:
  JsonEntry(const nlohmann::json& value, std::string file, nlohmann::json::json_pointer place)
      : value_(value), file_(std::move(file)), place_(std::move(place)) {}

  JsonEntry operator[](const std::string& key) const {
    require(value_.is_object(), "must be a JSON object (names with values)");
    const auto found = value_.find(key);
    if (found == value_.end()) JsonEntry(value_, file_, place_ / key).fail("is missing");
    return JsonEntry(*found, file_, place_ / key);
  }

  double number() const {
    require(value_.is_number(), "must be a finite number");
    return value_.get<double>();
  }
  bool boolean() const {
    require(value_.is_boolean(), "must be true or false");
    return value_.get<bool>();
  }
  std::string text() const {
    require(value_.is_string(), "must be a string");
    return value_.get<std::string>();
  }
  /// Applies `read` to each element of an array.
  template <typename Read>
  auto list(Read read) const {
    require(value_.is_array(), "must be an array");
    std::vector<decltype(read(*this))> result;
    result.reserve(value_.size());
    for (std::size_t i = 0; i < value_.size(); ++i)
      result.push_back(read(JsonEntry(value_[i], file_, place_ / i)));
    return result;
  }
  template <typename Read>
  auto triple(Read read) const {
    require(value_.is_array() && value_.size() == 3, "must be an array of 3 elements");
    const auto values = list(read);
    return std::array{values[0], values[1], values[2]};
  }
  std::vector<double> numbers() const {
    return list([](const JsonEntry& entry) { return entry.number(); });
  }
  std::array<double, 3> vector() const {
    return triple([](const JsonEntry& entry) { return entry.number(); });
  }
  std::array<std::array<double, 3>, 3> matrix() const {
    return triple([](const JsonEntry& entry) { return entry.vector(); });
  }
  /// Applies `read` to each entry of an object.
  template <typename Read>
  auto by_name(Read read) const {
    require(value_.is_object(), "must be a JSON object (names with values)");
    std::map<std::string, decltype(read(*this))> result;
    for (const auto& item : value_.items()) result[item.key()] = read((*this)[item.key()]);
    return result;
  }
  std::map<std::string, std::string> texts() const {
    return by_name([](const JsonEntry& entry) { return entry.text(); });
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw UserError(file_ + ": " + (place_.empty() ? "the document" : place_.to_string()) + " " +
                    what);
  }
  void require(bool fine, const std::string& rule) const {
    if (!fine) fail(rule + ", but is " + excerpt());
  }

 private:
  std::string excerpt() const {
    constexpr std::size_t longest = 60;
    const std::string whole = value_.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return whole.size() <= longest ? whole : whole.substr(0, longest) + "...";
  }

  const nlohmann::json& value_;
  std::string file_;
  nlohmann::json::json_pointer place_;
};

}  // namespace vibrissa::signals
