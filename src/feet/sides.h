// Left and right.
#pragma once

#include <array>

#include "base/segments.h"

namespace ukemi {

enum class BodySide { left, right };
inline constexpr std::array<BodySide, 2> kSides = {BodySide::left, BodySide::right};
constexpr BodySide other(BodySide side) { return side == BodySide::left ? BodySide::right : BodySide::left; }
constexpr int index(BodySide side) { return static_cast<int>(side); }
/// -1 left, 1 right: along the body's right.
constexpr double sign(BodySide side) { return side == BodySide::left ? -1.0 : 1.0; }
template <typename T>
using PerSide = std::array<T, 2>;

/// The segment or joint of a side that corresponds to the right one.
inline Segment on(BodySide side, Segment right) { return side == BodySide::right ? right : mirror_of(right); }
inline Joint on(BodySide side, Joint right) { return side == BodySide::right ? right : mirror_of(right); }

}  // namespace ukemi
