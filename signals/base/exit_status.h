#pragma once

/// Exit statuses of programs, which scripts rely on: 70 and 74 as in sysexits.h (EX_SOFTWARE,
/// EX_IOERR), 130 as shells have it for Ctrl-C. Proven by tests/apps/exit_status_test.cc.
namespace vibrissa::signals::exit_status {

inline constexpr int bad_input = 2;        // UserError
inline constexpr int too_little_data = 3;  // diagnosis::TooLittleData
inline constexpr int fault = 70;           // InternalError, and whatever else is thrown
inline constexpr int no_resource = 74;     // ResourceError, std::bad_alloc
inline constexpr int interrupted = 130;

}  // namespace vibrissa::signals::exit_status
