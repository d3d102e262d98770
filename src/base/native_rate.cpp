#include "base/native_rate.h"

#include <cmath>
#include <vector>

#include "base/quantile.h"

namespace ukemi {

double native_rate(const Animation& animation) {
  constexpr std::size_t kStray = 500;  // one spacing in so many may be shorter
  if (animation.fps > 0.0) return animation.fps;
  std::vector<double> spacings;
  for (const Track& track : animation.tracks)
    for (std::size_t i = 1; i < track.times.size(); ++i)
      if (track.times[i] > track.times[i - 1]) spacings.push_back(track.times[i] - track.times[i - 1]);
  if (spacings.empty()) return 0.0;
  const std::size_t least = spacings.size() / kStray;
  const double rate = 1.0 / ranked(std::move(spacings), least);
  const double whole = std::round(rate);
  return std::abs(rate - whole) < 1e-3 * rate ? whole : rate;
}

}  // namespace ukemi
