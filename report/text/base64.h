#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace vibrissa::report {

/// The bytes in base64 (RFC 4648) with padding. Proven by
/// tests/report/figures/packed_numbers_test.cc.
std::string base64(std::span<const std::byte> bytes);

}  // namespace vibrissa::report
