// Expected failures are values: Result<T> holds a T or an Error that says what, where and how to fix it.
// A broken precondition is an assert. Partial trouble goes to Diagnostics as a warning; stages never print.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace ukemi {

/// What went wrong, in the terms of the program's exit status (see exit_status).
enum class ErrorKind {
  usage,       // command line or recipe: status 2
  input,       // a file that is missing, malformed or not a humanoid: status 2
  simulation,  // the simulation failed: status 3
  output,      // cannot write: status 4
  internal,    // our bug: status 70
};

/// An expected failure. Empty or zero fields do not apply.
struct Error {
  ErrorKind kind = ErrorKind::internal;
  std::string file;   // as the user wrote it
  int line = 0;       // 1-based
  int column = 0;     // 1-based
  std::string joint;  // joint, segment or node
  std::string what;   // one sentence without a full stop: what is wrong
  std::string fix;    // one sentence without a full stop: what to do

  /// "file:line:column: joint 'X': what"
  std::string message() const;
};

/// 2 usage and input, 3 simulation, 4 output, 70 internal.
int exit_status(ErrorKind kind);

struct Warning {
  std::string subject;  // file, joint or stage; may be empty
  std::string what;
};

/// Collects warnings; each is said once.
class Diagnostics {
 public:
  void warn(std::string subject, std::string what);
  const std::vector<Warning>& warnings() const { return warnings_; }

 private:
  std::vector<Warning> warnings_;
};

/// A value or an Error. Check with `if (!result)`, read with *result or result->member.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return state_.index() == 0; }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const {
    assert(state_.index() == 1);
    return std::get<1>(state_);
  }

 private:
  T& value() {
    assert(state_.index() == 0);
    return std::get<0>(state_);
  }
  const T& value() const {
    assert(state_.index() == 0);
    return std::get<0>(state_);
  }
  std::variant<T, Error> state_;
};

/// Result of something that has no value.
struct Done {};
using Status = Result<Done>;

}  // namespace ukemi
