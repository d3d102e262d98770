#include <cassert>

#include "bullet_peer.h"

namespace ukemi {

bool has_bullet() { return false; }

Sample bullet_sample(const Prepared&, const Scene&, int, double) {
  assert(false);
  return {};
}

}  // namespace ukemi
