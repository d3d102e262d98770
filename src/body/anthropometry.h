// Segment masses, centres and radii of gyration of de Leva 1996 (adjusted Zatsiorsky-Seluyanov, young
// adults).
#pragma once

#include "base/math.h"
#include "base/segments.h"
#include "body/body.h"

namespace ukemi {

struct SegmentTable {
  double mass_fraction;  // of the body
  double length;         // fraction of stature
  double centre;  // of the length, from the proximal end (pelvis, abdomen, chest, head: from the lower end)
  Vec3 gyration;  // radii about x (anteroposterior), y (up) and z (mediolateral), fractions of the length
};

/// Row of a segment; clavicles, which the source does not have, take 0.018 of the mass each out of the chest.
SegmentTable segment_table(Segment segment, Sex sex);

/// 73 kg (height / 1.741 m)^3 for a man, 61.9 kg (height / 1.735 m)^3 for a woman: the source's mean
/// subjects, scaled.
double default_mass_kg(double height_m, Sex sex);

}  // namespace ukemi
