// Draws frames: figure, props and floor, lit, with shadows.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "render/camera.h"
#include "render/drawn_character.h"
#include "render/offscreen.h"
#include "render/render.h"
#include "render/theme.h"

namespace ukemi {

struct StageView {
  Camera camera;
  double floor_y = 0.0;
  Vec3 focus = Vec3::Zero();  // middle of the action, on the floor
  double reach = 2.0;         // metres from the focus where the floor begins to fade
  Theme theme = ukemi::theme(ThemeKind::light);
};

/// One off-screen context with pictures of one size. One at a time on a thread; the next of the same size
/// takes over what it drew with.
class Painter {
 public:
  /// `textures`: image i of the character, empty where it is not used. Errors: output.
  static Result<std::unique_ptr<Painter>> make(int width, int height, const std::vector<Picture>& textures,
                                               OffscreenKind kind = OffscreenKind::any);
  ~Painter();

  Picture draw(const FrameGeometry& frame, const StageView& stage);

 private:
  struct State;
  struct Spare;
  explicit Painter(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace ukemi
