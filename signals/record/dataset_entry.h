#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "signals/record/bench_setup.h"
#include "signals/record/split.h"

namespace vibrissa::signals {

/// What the entries of dataset.json have in common. where: the file and the place in it, for
/// messages. Proven by tests/signals/files/dataset_test.cc.

/// Throws UserError with the place of an entry of dataset.json and the error.
[[noreturn]] void refuse_dataset(const std::string& where, const std::string& reason);
/// Throws UserError for an entry that is not one of the keys (lists them).
void refuse_unknown_entries(const nlohmann::json& object, const std::vector<std::string>& keys,
                            const std::string& where);
/// The text of an entry, or the fallback where it is missing. Throws UserError for another type.
std::string text_of(const nlohmann::json& object, const std::string& key, const std::string& where,
                    const std::string& fallback);
/// The entry 'file'. Throws UserError where it is missing.
std::string file_of(const nlohmann::json& entry, const std::string& where);
/// The entry 'split': fit (also where it is missing) or held_out. Throws UserError for another.
Split split_of(const nlohmann::json& entry, const std::string& where);
/// The setup of the entry, or that of the whole document.
BenchSetup setup_of(const nlohmann::json& document, const nlohmann::json& entry,
                    const std::string& where);

}  // namespace vibrissa::signals
