// Random numbers that are the same everywhere, which those of the standard distributions are not.
#pragma once

#include <cstdint>

namespace ukemi {

/// SplitMix64 (Steele, Lea, Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// In [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * 0x1p-53 * static_cast<double>(next() >> 11);
  }

 private:
  std::uint64_t state_;
};

}  // namespace ukemi
