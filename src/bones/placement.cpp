// Whether bones lie in the tree as those of a body do.
#include <fmt/format.h>

#include "bones/bones.h"

namespace ukemi {
namespace {

struct Placement {
  const Character& character;
  const Bones& bones;

  std::string text(Segment s) const {
    return fmt::format("{} ({})", name(s), character.skeleton.label(bones[s]));
  }
  bool below(Segment upper, Segment lower) const {
    return character.skeleton.is_ancestor(bones[upper], bones[lower]);
  }

  /// A hand or foot that hangs on a limb that it is no end of.
  std::string end_of_another() const {
    for (const Segment end : {Segment::hand_l, Segment::hand_r, Segment::foot_l, Segment::foot_r})
      for (const Segment upper :
           {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l, Segment::thigh_r})
        if (bones[end] >= 0 && index(upper) != index(end) - 2 &&
            is_at_or_below(character.skeleton, bones[upper], bones[end]))
          return fmt::format("{} hangs below {}", text(end), text(upper));
    return {};
  }

  /// A bone that must hang below another; hands and feet may hang elsewhere (IK), but not above.
  std::string limb() const {
    constexpr std::pair<Segment, Segment> kMust[] = {
        {Segment::upperarm_l, Segment::forearm_l},  {Segment::upperarm_r, Segment::forearm_r},
        {Segment::thigh_l, Segment::shank_l},       {Segment::thigh_r, Segment::shank_r},
        {Segment::clavicle_l, Segment::upperarm_l}, {Segment::clavicle_r, Segment::upperarm_r}};
    for (const auto& [upper, lower] : kMust)
      if (bones[upper] >= 0 && bones[lower] >= 0 && !below(upper, lower))
        return fmt::format("{} does not hang below {}", text(lower), text(upper));
    constexpr std::pair<Segment, Segment> kMay[] = {{Segment::forearm_l, Segment::hand_l},
                                                    {Segment::forearm_r, Segment::hand_r},
                                                    {Segment::shank_l, Segment::foot_l},
                                                    {Segment::shank_r, Segment::foot_r}};
    for (const auto& [upper, lower] : kMay)
      if (bones[lower] >= 0 && is_at_or_below(character.skeleton, bones[lower], bones[upper]))
        return fmt::format("{} hangs above {}", text(lower), text(upper));
    return {};
  }

  std::string trunk() const {
    const Skeleton& skeleton = character.skeleton;
    const int legs = common_ancestor(skeleton, bones[Segment::thigh_l], bones[Segment::thigh_r]);
    const int arms = common_ancestor(skeleton, bones[Segment::upperarm_l], bones[Segment::upperarm_r]);
    const int whole = common_ancestor(skeleton, legs, arms);
    if (legs < 0)
      return fmt::format("{} and {} hang on nothing that carries both", text(Segment::thigh_l),
                         text(Segment::thigh_r));
    if (whole < 0)
      return fmt::format("{} and {} hang on nothing that carries both", text(Segment::thigh_l),
                         text(Segment::upperarm_l));
    const int meets = common_ancestor(skeleton, bones[Segment::pelvis], legs);
    if (!is_at_or_below(skeleton, whole, meets) && !is_at_or_below(skeleton, bones[Segment::pelvis], legs))
      return fmt::format("{} does not belong to the body that {} belongs to", text(Segment::pelvis),
                         text(Segment::thigh_l));
    for (const Segment limb : {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l, Segment::thigh_r})
      if (is_at_or_below(skeleton, bones[limb], bones[Segment::pelvis]))
        return fmt::format("{} hangs below {}", text(Segment::pelvis), text(limb));
    const int neck = common_ancestor(skeleton, bones[Segment::head], arms);
    if (neck < 0 ||
        !(is_at_or_below(skeleton, whole, neck) || is_at_or_below(skeleton, bones[Segment::pelvis], neck)))
      return fmt::format("{} does not belong to the body that {} belongs to", text(Segment::head),
                         text(Segment::upperarm_l));
    for (const Segment limb :
         {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l, Segment::thigh_r, Segment::pelvis})
      if (is_at_or_below(skeleton, bones[Segment::head], bones[limb]))
        return fmt::format("{} hangs above {}", text(Segment::head), text(limb));
    for (const Segment limb : {Segment::upperarm_l, Segment::upperarm_r, Segment::thigh_l, Segment::thigh_r})
      if (is_at_or_below(skeleton, bones[limb], bones[Segment::head]))
        return fmt::format("{} hangs below {}", text(Segment::head), text(limb));
    return {};
  }

  /// Abdomen and chest lie between pelvis and head, in that order.
  std::string spine() const {
    const Skeleton& skeleton = character.skeleton;
    Segment below_it = Segment::pelvis;
    for (const Segment s : {Segment::abdomen, Segment::chest}) {
      if (bones[s] < 0) continue;
      const bool above = below_it == Segment::pelvis
                             ? bones[s] != bones[Segment::pelvis] &&
                                   !is_at_or_below(skeleton, bones[s], bones[Segment::pelvis])
                             : below(below_it, s);
      if (!above) return fmt::format("{} does not hang above {}", text(s), text(below_it));
      if (!below(s, Segment::head)) return fmt::format("{} does not carry {}", text(s), text(Segment::head));
      below_it = s;
    }
    const bool arms_on_spine = !is_at_or_below(
        skeleton, common_ancestor(skeleton, bones[Segment::upperarm_l], bones[Segment::upperarm_r]),
        bones[Segment::pelvis]);
    if (bones[Segment::abdomen] >= 0 && bones[Segment::chest] < 0 && arms_on_spine &&
        !below(Segment::abdomen, Segment::upperarm_l))
      return fmt::format("{} does not carry {}", text(Segment::abdomen), text(Segment::upperarm_l));
    return {};
  }
};

}  // namespace

std::string misplaced(const Character& character, const Bones& bones) {
  const Placement placement{character, bones};
  for (std::string (Placement::*check)() const :
       {&Placement::limb, &Placement::end_of_another, &Placement::trunk, &Placement::spine})
    if (std::string what = (placement.*check)(); !what.empty()) return what;
  return {};
}

}  // namespace ukemi
