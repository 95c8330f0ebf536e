#include "signals/record/dataset_entry.h"

#include <algorithm>

#include "signals/base/error.h"

namespace vibrissa::signals {

using nlohmann::json;

void refuse_dataset(const std::string& where, const std::string& reason) {
  throw UserError(where + ": " + reason);
}

void refuse_unknown_entries(const json& object, const std::vector<std::string>& keys,
                            const std::string& where) {
  for (const auto& item : object.items())
    if (std::find(keys.begin(), keys.end(), item.key()) == keys.end())
      refuse_dataset(where, unknown_name("entry", item.key(), keys));
}

std::string text_of(const json& object, const std::string& key, const std::string& where,
                    const std::string& fallback) {
  if (!object.contains(key)) return fallback;
  if (!object[key].is_string()) refuse_dataset(where + "/" + key, "must be a string");
  return object[key];
}

std::string file_of(const json& entry, const std::string& where) {
  const std::string file = text_of(entry, "file", where, "");
  if (file.empty())
    refuse_dataset(where, "the entry 'file' is missing or empty; name the file of the record");
  return file;
}

Split split_of(const json& entry, const std::string& where) {
  const std::string word = text_of(entry, "split", where, "fit");
  if (word == "fit") return Split::fit;
  if (word == "held_out") return Split::held_out;
  refuse_dataset(where + "/split", unknown_name("split", word, {"fit", "held_out"}));
}

BenchSetup setup_of(const json& document, const json& entry, const std::string& where) {
  if (entry.contains("setup")) return read_bench_setup(entry["setup"], where + "/setup");
  return document.contains("setup") ? read_bench_setup(document["setup"], where + ", from /setup")
                                    : BenchSetup{};
}

}  // namespace vibrissa::signals
