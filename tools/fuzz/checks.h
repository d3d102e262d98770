// What a fuzzer expects of accepted input, beyond that nothing crashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/character.h"
#include "base/result.h"
#include "restrict/range_of_motion.h"

/// libFuzzer's entry: one input. Defined by each fuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace ukemi::fuzz {

/// Says what does not hold and aborts.
void require(bool holds, const char* what);

/// A refusal says what is wrong and is no bug of ours.
void require_clear(const Error& error);
/// The contracts of Skeleton, Track, MeshPart and Skin.
void require_sound(const Character& character);
/// The contract of JointRange.
void require_sound(const RangeOfMotion& range);

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace ukemi::fuzz
