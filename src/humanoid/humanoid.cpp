#include "humanoid/humanoid.h"

#include "humanoid/assemble.h"
#include "humanoid/bones.h"
#include "humanoid/frames.h"

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

Result<Humanoid> map_humanoid(const Character& character, const HumanoidOptions& options,
                              Diagnostics& diagnostics) {
  const Result<Bones> bones = find_bones(character, options);
  if (!bones) return bones.error();
  Humanoid humanoid;
  assemble(character, *bones, humanoid);
  if (Status status = find_frames(character, options, humanoid, diagnostics); !status) return status.error();
  return humanoid;
}

}  // namespace ukemi
