#include "body/anthropometry.h"

namespace ukemi {
namespace {

constexpr double kClavicleMass = 0.018;

struct Row {
  double mass, length, centre, about_anteroposterior, about_mediolateral, about_long;
};

// De Leva 1996, table 4; lengths over stature from its reference subjects (1.741 m, 1.735 m). Centres of the
// trunk and head are given there from the upper end and turned round here.
struct Pair {
  Row male, female;
};
constexpr Pair kHead{{.0694, .1395, 1 - .5002, .303, .315, .261},
                     {.0668, .1405, 1 - .4841, .271, .295, .261}};
constexpr Pair kChest{{.1596, .1391, 1 - .5066, .505, .320, .465},
                      {.1545, .1314, 1 - .5050, .466, .314, .449}};
constexpr Pair kAbdomen{{.1633, .1238, 1 - .4502, .482, .383, .468},
                        {.1465, .1183, 1 - .4512, .433, .354, .415}};
constexpr Pair kPelvis{{.1117, .0837, 1 - .6115, .615, .551, .587},
                       {.1247, .1046, 1 - .4920, .433, .402, .444}};
constexpr Pair kUpperArm{{.0271, .1618, .5772, .285, .269, .158}, {.0255, .1586, .5754, .278, .260, .148}};
constexpr Pair kForearm{{.0162, .1545, .4574, .276, .265, .121}, {.0138, .1523, .4559, .261, .257, .094}};
constexpr Pair kHand{{.0061, .1079, .3624, .288, .235, .184}, {.0056, .0980, .3427, .244, .208, .154}};
constexpr Pair kThigh{{.1416, .2425, .4095, .329, .329, .149}, {.1478, .2124, .3612, .369, .364, .162}};
constexpr Pair kShank{{.0433, .2529, .4395, .251, .246, .102}, {.0481, .2528, .4352, .267, .263, .092}};
constexpr Pair kFoot{{.0137, .1482, .4415, .257, .245, .124}, {.0129, .1316, .4014, .299, .279, .139}};
// Length of a clavicle over stature; a slender rod.
constexpr Row kClavicle{kClavicleMass, .085, .5, .289, .289, .289};

Row row(Segment segment, Sex sex) {
  const auto pick = [&](const Pair& pair) { return sex == Sex::male ? pair.male : pair.female; };
  switch (segment) {
    case Segment::pelvis:
      return pick(kPelvis);
    case Segment::abdomen:
      return pick(kAbdomen);
    case Segment::chest: {
      Row chest = pick(kChest);
      chest.mass -= 2.0 * kClavicleMass;
      return chest;
    }
    case Segment::head:
      return pick(kHead);
    case Segment::clavicle_l:
    case Segment::clavicle_r:
      return kClavicle;
    case Segment::upperarm_l:
    case Segment::upperarm_r:
      return pick(kUpperArm);
    case Segment::forearm_l:
    case Segment::forearm_r:
      return pick(kForearm);
    case Segment::hand_l:
    case Segment::hand_r:
      return pick(kHand);
    case Segment::thigh_l:
    case Segment::thigh_r:
      return pick(kThigh);
    case Segment::shank_l:
    case Segment::shank_r:
      return pick(kShank);
    case Segment::foot_l:
    case Segment::foot_r:
      break;
  }
  return pick(kFoot);
}

}  // namespace

SegmentTable segment_table(Segment segment, Sex sex) {
  const Row r = row(segment, sex);
  const bool foot = segment == Segment::foot_l || segment == Segment::foot_r;
  // The long axis is y, but x for the foot, whose "anteroposterior" column is then about y.
  const Vec3 gyration = foot ? Vec3(r.about_long, r.about_anteroposterior, r.about_mediolateral)
                             : Vec3(r.about_anteroposterior, r.about_long, r.about_mediolateral);
  return {r.mass, r.length, r.centre, gyration};
}

double default_mass_kg(double height_m, Sex sex) {
  const double relative = height_m / (sex == Sex::male ? 1.741 : 1.735);
  return (sex == Sex::male ? 73.0 : 61.9) * relative * relative * relative;
}

}  // namespace ukemi
