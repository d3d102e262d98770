// Moving pictures: a clip frame by frame, as an animated WebP or one picture after the other.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "render/render.h"

namespace ukemi {

/// An animated WebP that loops for ever, made frame by frame.
class AnimationEncoder {
 public:
  /// `quality`: 0 to 100, lossy.
  AnimationEncoder(int width, int height, double fps, double quality);
  ~AnimationEncoder();

  /// Contract: the size given at the start. Errors: output.
  Status add(const Picture& picture);
  /// The file's bytes. Errors: output, without a frame too.
  Result<std::vector<std::uint8_t>> finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ukemi
