// A body posed by least squares: what it should look like, what it must touch, where its weight may lie.
#pragma once

#include <optional>
#include <vector>

#include "body/body.h"
#include "restrict/range_of_motion.h"

namespace ukemi {

/// A pose in the terms in which it is searched: the pelvis in the world, every joint relative to its parent.
struct FigurePose {
  Vec3 place = Vec3::Zero();     // origin of the pelvis, world, metres
  Quat turn = Quat::Identity();  // world_from_pelvis
  PerJoint<Quat> joints = [] {
    PerJoint<Quat> q;
    q.fill(Quat::Identity());
    return q;
  }();  // parent_from_child
};

/// Points of the skin that can touch the floor, in the frames of their segments (outermost_skin).
using OuterSkin = PerSegment<std::vector<Vec3>>;

FigurePose figure_pose(const BodyPose& segments);
/// Forward kinematics over the body's anchors.
BodyPose segments_of(const ArticulatedBody& body, const FigurePose& figure);

/// A point of a segment (its frame, metres) that shall be at `target` (world); weight per world axis, 1/m.
struct PointGoal {
  Segment segment = Segment::pelvis;
  Vec3 point = Vec3::Zero();
  Vec3 target = Vec3::Zero();
  Vec3 weight = Vec3::Zero();
};

/// A segment's rotation; weight 1/rad.
struct TurnGoal {
  Segment segment = Segment::pelvis;
  Quat target = Quat::Identity();
  double weight = 0.0;
};

/// An axis of a segment (its frame, unit) that shall point along `direction` (world, unit); weight 1/rad.
struct AxisGoal {
  Segment segment = Segment::pelvis;
  Vec3 axis = Vec3::UnitY();
  Vec3 direction = Vec3::UnitY();
  double weight = 0.0;
};

/// The lowest of these points lies on the floor or at the given height above it; weight 1/m.
struct TouchGoal {
  const OuterSkin* points = nullptr;
  double weight = 0.0;
  double height_m = 0.0;
};

struct PoseGoals {
  FigurePose likeness;
  PerJoint<double> likeness_weight{};       // 1/rad
  Vec3 place_weight = Vec3::Constant(3.0);  // of the pelvis, 1/m
  double turn_weight = 3.0;                 // 1/rad
  std::vector<PointGoal> points;
  std::vector<TurnGoal> turns;
  std::vector<AxisGoal> axes;
  std::vector<TouchGoal> touches;
  std::vector<std::vector<Vec2>> supports;  // hulls (x, z): the centre of mass stays inside each of them
  double support_weight = 0.0;              // 1/m
  std::optional<Vec2> balance;              // where the centre of mass lies (x, z)
  double balance_weight = 0.0;              // 1/m
  double floor_weight = 400.0;              // of skin below y = 0, 1/m
  double floor_m = 0.0;                     // height that skin keeps, where it does not touch on purpose
  double margin = 0.0;                      // inside their ranges that joints keep, radians
};

struct Equations;

/// Solves PoseGoals by damped Gauss-Newton steps (Levenberg 1944) over the pelvis and all joints that are not
/// fused. Joints stay in their ranges shrunk by the margin: a joint that leaves is drawn back with a weight
/// of its own, and set inside at the end.
class WholeBody {
 public:
  WholeBody(const ArticulatedBody& body, const RangeOfMotion& range, const OuterSkin& skin)
      : body_(body), range_(range), skin_(skin) {}

  FigurePose reach(const PoseGoals& goals, FigurePose figure, int steps) const;
  /// Every joint inside its range.
  FigurePose inside(FigurePose figure, double margin) const;
  /// Charts of the joints (those of fused ones are not used), and the joints that have them.
  PerJoint<SwingTwist> charts(const PerJoint<Quat>& joints) const;
  PerJoint<Quat> joints(const PerJoint<SwingTwist>& charts) const;
  BodyPose segments(const FigurePose& figure) const { return segments_of(body_, figure); }
  Vec3 centre_of_mass(const BodyPose& segments) const;
  /// Height of the lowest skin of a segment; infinite where it has none.
  double lowest(const BodyPose& segments, Segment segment) const;
  double lowest(const BodyPose& segments) const;
  const ArticulatedBody& body() const { return body_; }
  const OuterSkin& skin() const { return skin_; }

 private:
  void add_goals(const PoseGoals& goals, const FigurePose& figure, Equations& equations) const;
  void add_likeness(const PoseGoals& goals, const FigurePose& figure, const BodyPose& segments,
                    Equations& equations) const;
  void add_point(const PointGoal& goal, const BodyPose& segments, Equations& equations) const;
  void add_floor(const PoseGoals& goals, const BodyPose& segments, Equations& equations) const;
  void add_balance(const PoseGoals& goals, const BodyPose& segments, Equations& equations) const;
  FigurePose stepped(const FigurePose& figure, const Equations& equations, double damping) const;

  const ArticulatedBody& body_;
  const RangeOfMotion& range_;
  const OuterSkin& skin_;
};

/// Convex hull of points on the ground, counter-clockwise.
std::vector<Vec2> hull_of(std::vector<Vec2> points);
/// Way from the point to the hull, zero inside. Hulls of one or two corners count as points and lines.
Vec2 way_into(const std::vector<Vec2>& hull, const Vec2& point);
/// The hull drawn in to its middle by `margin` metres at every corner, at most to the middle.
std::vector<Vec2> drawn_in(const std::vector<Vec2>& hull, double margin);

}  // namespace ukemi
