// SHA-256: what a reaction is made from and what was written, told apart by their content.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace ukemi {

/// SHA-256 (FIPS 180-4) over everything that is added, in the order it is added.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(std::span<const std::uint8_t> bytes);
  void add(std::string_view text);
  /// Length first, so that no two sequences of fields give the same bytes.
  void add_field(std::string_view text);
  /// 64 hexadecimal digits; nothing may be added afterwards.
  std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string digest_of(std::span<const std::uint8_t> bytes);
std::string digest_of(std::string_view text);

}  // namespace ukemi
