#include "humanoid/humanoid.h"

namespace ukemi {

std::string_view name(RestPoseClass pose) {
  switch (pose) {
    case RestPoseClass::t_pose:
      return "T";
    case RestPoseClass::a_pose:
      return "A";
    case RestPoseClass::neutral:
      return "neutral";
    case RestPoseClass::other:
      break;
  }
  return "other";
}

}  // namespace ukemi
