// Triangles to samples: coverage and depth on a grid.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/math.h"

namespace ukemi {

/// A corner on the grid: x to the right, y down, in samples; depth grows away from the eye.
struct Corner {
  float x = 0.0f, y = 0.0f, depth = 0.0f;
};

/// Calls visit(sample, weights, depth) for each sample whose centre lies in the triangle; a centre on an edge
/// that two triangles share belongs to one of them. `visit` is given the sample's index (row by row), the
/// corners' weights and the depth. Either winding.
template <typename Visit>
void for_each_sample(const std::array<Corner, 3>& corners, int width, int height, const Visit& visit) {
  const auto [lowest_x, highest_x] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [lowest_y, highest_y] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  if (!(lowest_x < w && lowest_y < h && highest_x > 0.0f && highest_y > 0.0f)) return;
  const int left = static_cast<int>(std::max(lowest_x + 0.5f, 0.0f));
  const int top = static_cast<int>(std::max(lowest_y + 0.5f, 0.0f));
  const int right = static_cast<int>(std::min(highest_x + 0.5f, w)) - 1;
  const int bottom = static_cast<int>(std::min(highest_y + 0.5f, h)) - 1;
  const auto doubled_area = [](const Corner& a, const Corner& b, float x, float y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  };
  const float area = doubled_area(corners[0], corners[1], corners[2].x, corners[2].y);
  if (!(std::abs(area) > 1e-12f)) return;
  const float side = area > 0.0f ? 1.0f : -1.0f;
  std::array<bool, 3> owns{};  // of the edge opposite to corner i, the samples on it
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = corners[(i + 1) % 3], &b = corners[(i + 2) % 3];
    const float dx = side * (b.x - a.x), dy = side * (b.y - a.y);
    owns[i] = dy > 0.0f || (dy == 0.0f && dx < 0.0f);
  }
  const float inverse = 1.0f / area;
  std::array<float, 3> step{};  // of the weights, from sample to sample
  for (std::size_t i = 0; i < 3; ++i) step[i] = inverse * (corners[(i + 1) % 3].y - corners[(i + 2) % 3].y);
  for (int y = top; y <= bottom; ++y) {
    std::array<float, 3> first{};  // at the row's first sample
    for (std::size_t i = 0; i < 3; ++i)
      first[i] = inverse * doubled_area(corners[(i + 1) % 3], corners[(i + 2) % 3],
                                        static_cast<float>(left) + 0.5f, static_cast<float>(y) + 0.5f);
    for (int x = left; x <= right; ++x) {
      const auto n = static_cast<float>(x - left);
      const std::array<float, 3> weights = {first[0] + n * step[0], first[1] + n * step[1],
                                            first[2] + n * step[2]};
      const auto holds = [&](std::size_t i) { return weights[i] > 0.0f || (weights[i] == 0.0f && owns[i]); };
      if (!holds(0) || !holds(1) || !holds(2)) continue;
      const float depth =
          weights[0] * corners[0].depth + weights[1] * corners[1].depth + weights[2] * corners[2].depth;
      visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
            weights, depth);
    }
  }
}

}  // namespace ukemi
