// Another build's bench program, asked for one run at a time.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>

#include "base/result.h"
#include "sample.h"

namespace ukemi {

/// What is asked for on a line of a serving program's input, and what it answers on one of its output.
inline constexpr const char* kServe = "--serve";

class OtherBuild {
 public:
  /// Starts `program --serve CHARACTER HITS SECONDS`. Errors: usage (it does not serve).
  static Result<OtherBuild> start(const std::string& program, const std::string& character, int hits,
                                  double duration_s);
  ~OtherBuild();
  OtherBuild(OtherBuild&& other) noexcept;
  OtherBuild& operator=(OtherBuild&&) = delete;

  /// Errors: usage (it has ended, or answers something else).
  Result<Sample> sample(int hit, const std::string& run);

 private:
  OtherBuild() = default;
  Error silent() const;

  std::string program_;
  pid_t pid_ = -1;
  std::FILE* questions_ = nullptr;
  std::FILE* answers_ = nullptr;
};

}  // namespace ukemi
