#include "humanoid/humanoid.h"

#include "bones/bones.h"
#include "humanoid/assemble.h"
#include "humanoid/frames.h"
#include "humanoid/twist.h"

namespace ukemi {

namespace {

Result<Humanoid> humanoid_of(const Character& character, const Bones& bones, const HumanoidOptions& options,
                             Diagnostics& diagnostics) {
  Humanoid humanoid;
  assemble(character, bones, humanoid);
  if (Status status = find_frames(character, options, humanoid, diagnostics); !status) return status.error();
  humanoid.twist_bones = find_twist_bones(character.skeleton, humanoid);
  return humanoid;
}

}  // namespace

Result<Humanoid> map_humanoid(const Character& character, const HumanoidOptions& options,
                              Diagnostics& diagnostics) {
  const Result<Bones> bones = find_bones(character, options, diagnostics);
  if (!bones && bones.error().kind != ErrorKind::input) return bones.error();
  auto humanoid =
      bones ? humanoid_of(character, *bones, options, diagnostics) : Result<Humanoid>(bones.error());
  if (humanoid) return humanoid;
  // The names made no human; the shape may.
  const auto shape = find_bones_by_shape(character, options);
  if (!shape) return humanoid;
  auto shaped = humanoid_of(character, *shape, options, diagnostics);
  if (!shaped) return humanoid;
  diagnostics.warn(
      character.path.string(),
      "the names of the bones do not fit their places; the bones are taken by their shape: --map "
      "sets them");
  return shaped;
}

}  // namespace ukemi
