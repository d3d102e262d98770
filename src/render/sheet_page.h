// What sheets are made of: a heading with figures, labelled cells, the speed over time, a scale.
#pragma once

#include <string>
#include <vector>

#include "render/moments.h"
#include "render/page.h"
#include "render/staging.h"
#include "render/theme.h"

namespace ukemi {

/// How large and in which colours things are drawn on a page. A size of 1 suits cells 320 pixels wide.
struct Pen {
  const Fonts& fonts;
  const Theme& theme;
  double zoom = 1.0;

  int scaled(double pixels) const;
  double size(double pixels) const { return pixels * zoom; }
};

struct Heading {
  std::string title;
  std::vector<Fact> facts;
  std::vector<std::string> notes;
};

/// From the baseline of the title's capitals to below the last line, in a width of `room` pixels.
int heading_height(const Pen& pen, const Heading& heading, int room);
void draw_heading(Picture& page, const Pen& pen, const Heading& heading, int x, int y, int room);

/// Time, and the phase on a tag, in the upper left corner of a cell.
void draw_label(Picture& page, const Pen& pen, const Box& cell, const std::string& time,
                const std::string& phase);
/// Height that a label needs at the top of a cell.
int label_height(const Pen& pen);

/// Speed of a motion over time.
struct SpeedCurve {
  std::vector<double> speeds;  // m/s, per frame
  double fps = 60.0;
  std::vector<Moment> moments;
};

int timeline_height(const Pen& pen);
/// The curve, below it a dot for every cell and the seconds.
void draw_timeline(Picture& page, const Pen& pen, const SpeedCurve& timeline, const Box& box);

/// A bar as long as a metre (or a part or a multiple of it) at the stage's focus, and a text beside it.
/// Returns the x after it.
double draw_scale(Picture& page, const Pen& pen, const StageView& stage, int cell_height, int x, int baseline,
                  const std::string& remark);

}  // namespace ukemi
