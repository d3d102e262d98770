// Limits the memory that one glTF takes. Its parts may refer to the same bytes many times over, so a small
// file can ask for any amount.
#pragma once

#include <cstddef>
#include <string>

#include "load/json_view.h"

namespace ukemi::load {

class MemoryBudget {
 public:
  /// Counts bytes that `place` needs. Throws Refusal once all places together need more than 4 GiB.
  void spend(std::size_t bytes, const std::string& place) {
    if (bytes > left_)
      throw Refusal(place + ": with it the file's parts need more than 4 GiB of memory",
                    "use a simpler file");
    left_ -= bytes;
  }

 private:
  std::size_t left_ = std::size_t{4} << 30;
};

}  // namespace ukemi::load
