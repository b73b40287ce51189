// The two kinds of failure a user can meet, and the exit codes that go with them.
#pragma once

#include <stdexcept>
#include <string>

namespace pellicle {

enum class ExitCode : int { done = 0, bad_input = 2, run_failed = 3, interrupted = 130 };

/// Something the user wrote cannot be used. The message reads `file:line: key.path: what is wrong; what is allowed`.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A run that was well specified failed while running; the message says where, when, which particle or cell.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pellicle
