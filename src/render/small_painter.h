// Small pictures drawn without OpenGL: the painter's lights and floor at a tenth of its cost, in one thread
// and a few megabytes. Colours are computed at vertices, the figure casts no shadow on itself, and every
// machine gives the same bytes.
#pragma once

#include <vector>

#include "render/drawn_character.h"
#include "render/painter.h"
#include "render/render.h"
#include "render/theme.h"

namespace ukemi {

/// A frame, drawn once for all themes; the theme of `stage` is not looked at.
class SmallPainter {
 public:
  /// `textures`: image i of the character, empty where it is not used. Contract: everything lies in front of
  /// the camera.
  SmallPainter(int width, int height, const FrameGeometry& frame, const StageView& stage,
               const std::vector<Picture>& textures);

  Picture in(const Theme& theme) const;

 private:
  /// What a pixel shows of the figure, over how much of the floor.
  struct Figure {
    Eigen::Vector3f color = Eigen::Vector3f::Zero();
    float through = 1.0f;
  };
  /// Shares, 0 to 1.
  struct Floor {
    float ground = 0.0f;  // the rest is background
    float line = 0.0f;    // of the theme's line over it
    float bright = 1.0f;  // outside of shadows
  };

  void draw_figure(const FrameGeometry& frame, const StageView& stage, const std::vector<Picture>& textures);
  void draw_floor(const FrameGeometry& frame, const StageView& stage);

  int width_, height_;
  std::vector<Figure> figure_;
  std::vector<Floor> floor_;
};

}  // namespace ukemi
