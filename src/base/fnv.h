// FNV-1a, 64 bits: a hash for data that is not hostile. Where content must be told apart for certain:
// base/digest.h.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace ukemi {

/// http://www.isthe.com/chongo/tech/comp/fnv: h = (h xor byte) * prime, from the offset basis on.
class Fnv {
 public:
  void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) hash_ = (hash_ ^ byte) * 1099511628211ull;
  }
  void add(std::string_view text) {
    add(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ull;
};

}  // namespace ukemi
