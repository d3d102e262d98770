// A boxy skinned figure made in code, and a fall for it.
#pragma once

#include "base/animation.h"
#include "base/character.h"
#include "render/render.h"
#include "body/trajectory.h"

namespace ukemi {

/// 1.75 m tall, y up, facing +z, in metres; one skin, a box per bone, blended over two bones at the joints.
Character boxy_character();
/// Struck on the chest from the front at 0.2 s, falls backwards; `frames` at 30 per second.
Clip boxy_fall(const Character& character, int frames);
/// The ball that strikes it, one pose per frame of the clip.
std::vector<Prop> boxy_ball(const Clip& clip);

/// All of it, ready to be drawn.
struct BoxyScene {
  Character character = boxy_character();
  Clip clip = boxy_fall(character, 46);
  std::vector<Prop> props = boxy_ball(clip);
  Shot shot;

  BoxyScene();
  BoxyScene(const BoxyScene&) = delete;
  BoxyScene& operator=(const BoxyScene&) = delete;
};

/// Pixels of which a channel differs by more than `tolerance`. Contract: pictures of the same size.
int differing_pixels(const Picture& a, const Picture& b, int tolerance);

}  // namespace ukemi
