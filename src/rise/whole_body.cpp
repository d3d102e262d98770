#include "rise/whole_body.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "body/centre_of_mass.h"

namespace ukemi {
namespace {

constexpr int kVariables = 6 + 3 * kJointCount;
constexpr double kApart_m = 0.06;       // second lowest point of a segment from its lowest
constexpr double kLimitWeight = 200.0;  // 1/rad
constexpr double kDamping = 0.3;        // least, of a step: 1/rad^2 and 1/m^2
constexpr double kSmallestGain = 1e-5;  // of the cost, by a step worth taking
constexpr double kLongestStep = 0.5;    // radians or metres, of one iteration

using Normal = Eigen::Matrix<double, kVariables, kVariables>;
using Variables = Eigen::Matrix<double, kVariables, 1>;

/// How one number grows with the variables, without those that it does not depend on. Columns ascend.
struct Row {
  int count = 0;
  std::array<int, kVariables> columns;
  std::array<double, kVariables> values;

  void add(int column, double value) {
    if (value != 0.0) columns[count] = column, values[count++] = value;
  }
};

}  // namespace

/// PoseGoals at one pose: what is missing, squared and weighted, and the normal equations of the step that
/// mends it.
struct Equations {
  double cost = 0.0;
  Normal a = Normal::Zero();  // its lower triangle
  Variables b = Variables::Zero();

  void add(const Row& row, double residual, double weight) {
    const double w = weight * weight;
    cost += w * residual * residual;
    for (int k = 0; k < row.count; ++k) {
      const double value = w * row.values[k];
      double* const below = a.data() + kVariables * row.columns[k];
      for (int i = k; i < row.count; ++i) below[row.columns[i]] += value * row.values[i];
      b[row.columns[k]] += residual * value;
    }
  }
  /// Three variables wanted at `want` directly.
  void hold(int first, const Vec3& want, const Vec3& weight) {
    for (int i = 0; i < 3; ++i) {
      const double w = weight[i] * weight[i];
      cost += w * want[i] * want[i];
      a(first + i, first + i) += w;
      b[first + i] += w * want[i];
    }
  }
};

namespace {

int column(Joint joint) { return 6 + 3 * index(joint); }

/// Joints between the pelvis and a segment that move, from the pelvis on.
struct Chain {
  int count = 0;
  std::array<Segment, kJointCount> below;  // of each joint

  Chain(const ArticulatedBody& body, Segment segment) {
    for (Segment s = segment; s != Segment::pelvis; s = parent_of(s))
      if (!body.joints[index(joint_above(s))].fused) below[count++] = s;
    std::reverse(below.begin(), below.begin() + count);
  }
};

/// d(place)/d(turn about the centre) of one axis of the place.
void add_turning(int axis, int first, const Vec3& r, Row& row) {
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  for (int k = 0; k < 3; ++k)
    if (k != axis) row.add(first + k, k == next ? r[last] : -r[next]);
}

/// Row of d(point)/d(variables), for one axis, of a point that moves with a segment (world place).
Row point_row(const Chain& chain, const BodyPose& segments, int axis, const Vec3& place) {
  Row row;
  row.add(axis, 1.0);
  add_turning(axis, 3, place - segments[0].translation, row);
  for (int i = 0; i < chain.count; ++i)
    add_turning(axis, column(joint_above(chain.below[i])),
                place - segments[index(chain.below[i])].translation, row);
  return row;
}

void add_turn(const ArticulatedBody& body, Segment segment, const Vec3& want, double weight,
              Equations& equations) {
  const Chain chain(body, segment);
  for (int axis = 0; axis < 3; ++axis) {
    Row row;
    row.add(3 + axis, 1.0);
    for (int i = 0; i < chain.count; ++i) row.add(column(joint_above(chain.below[i])) + axis, 1.0);
    equations.add(row, want[axis], weight);
  }
}

/// Row of d(centre of mass)/d(variables) for one axis. A joint turns all that hangs on it.
Row weight_row(const ArticulatedBody& body, const BodyPose& segments, int axis) {
  PerSegment<double> mass{};
  PerSegment<Vec3> moment;  // mass times place
  for (int s = kSegmentCount - 1; s >= 0; --s) {
    mass[s] += body.segments[s].mass_kg;
    moment[s] = body.segments[s].mass_kg * (segments[s] * body.segments[s].centre_of_mass);
  }
  for (int s = kSegmentCount - 1; s > 0; --s) {
    const int parent = index(parent_of(segment_at(s)));
    mass[parent] += mass[s];
    moment[parent] += moment[s];
  }
  Row row;
  row.add(axis, 1.0);
  add_turning(axis, 3, (moment[0] - mass[0] * segments[0].translation) / body.mass_kg, row);
  for (int j = 0; j < kJointCount; ++j) {
    const int s = index(child_of(joint_at(j)));
    if (!body.joints[j].fused)
      add_turning(axis, column(joint_at(j)), (moment[s] - mass[s] * segments[s].translation) / body.mass_kg,
                  row);
  }
  return row;
}

JointRange shrunk_twist(const JointRange& range, double margin) {
  JointRange inner = range;
  inner.twist_min = std::min(0.0, range.twist_min + margin);
  inner.twist_max = std::max(0.0, range.twist_max - margin);
  return inner;
}

/// The rotation inside the range, a margin from its edge, nearest to `relative`; itself where it is inside.
Quat kept_inside(const JointRange& range, const Quat& relative, double margin) {
  const SwingTwist chart = swing_twist(range.frame.joint_from_relative(relative));
  SwingTwist inner = clamp_to_range(shrunk_twist(range, margin), chart);
  const double outside = polygon_distance(range.polygon, chart.swing) + margin;
  if (outside > 0.0) {
    const Vec2 edge = nearest_boundary_point(range.polygon, chart.swing);
    const Vec2 inwards = polygon_distance(range.polygon, chart.swing) > 0.0 ? Vec2(edge - chart.swing)
                                                                            : Vec2(chart.swing - edge);
    const double length = inwards.norm();
    inner.swing = length > 1e-9 ? Vec2(edge + margin / length * inwards) : Vec2(edge * (1.0 - margin));
  } else if (inner.twist == chart.twist) {
    return relative;
  }
  return range.frame.relative_from_joint(joint_rotation(inner));
}

struct Low {
  double height = std::numeric_limits<double>::infinity();
  Vec3 point = Vec3::Zero();
};

/// The lowest of a segment's points; `away_from`: of those that are apart from it.
Low lowest_of(const Rigid& at, const std::vector<Vec3>& points, const Vec3* away_from = nullptr) {
  const Vec3 up = at.rotation.conjugate() * Vec3::UnitY();
  Low low;
  for (const Vec3& p : points) {
    const double y = up.dot(p) + at.translation.y();
    if (y >= low.height || (away_from && (p - *away_from).norm() < kApart_m)) continue;
    low = {y, p};
  }
  return low;
}

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec2 nearest_on_line(const Vec2& a, const Vec2& b, const Vec2& point) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  return a + (length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0) * along;
}

}  // namespace

FigurePose figure_pose(const BodyPose& segments) {
  FigurePose figure;
  figure.place = segments[0].translation;
  figure.turn = segments[0].rotation;
  for (int j = 0; j < kJointCount; ++j)
    figure.joints[j] = (segments[index(parent_of(joint_at(j)))].rotation.conjugate() *
                        segments[index(child_of(joint_at(j)))].rotation)
                           .normalized();
  return figure;
}

BodyPose segments_of(const ArticulatedBody& body, const FigurePose& figure) {
  BodyPose segments;
  segments[0] = {figure.turn, figure.place};
  for (int j = 0; j < kJointCount; ++j) {
    const Rigid& parent = segments[index(parent_of(joint_at(j)))];
    const BodyJoint& joint = body.joints[j];
    segments[j + 1] = joint.fused ? parent * joint.parent_from_child
                                  : parent * Rigid{figure.joints[j], joint.anchor_in_parent};
  }
  return segments;
}

Vec3 WholeBody::centre_of_mass(const BodyPose& segments) const {
  return ukemi::centre_of_mass(body_, segments);
}

double WholeBody::lowest(const BodyPose& segments, Segment segment) const {
  return lowest_of(segments[index(segment)], skin_[index(segment)]).height;
}

double WholeBody::lowest(const BodyPose& segments) const {
  double low = std::numeric_limits<double>::infinity();
  for (int s = 0; s < kSegmentCount; ++s) low = std::min(low, lowest(segments, segment_at(s)));
  return low;
}

PerJoint<SwingTwist> WholeBody::charts(const PerJoint<Quat>& joints) const {
  PerJoint<SwingTwist> charts;
  for (int j = 0; j < kJointCount; ++j)
    charts[j] = swing_twist(range_.joints[j].frame.joint_from_relative(joints[j]));
  return charts;
}

PerJoint<Quat> WholeBody::joints(const PerJoint<SwingTwist>& charts) const {
  PerJoint<Quat> joints;
  for (int j = 0; j < kJointCount; ++j)
    joints[j] = range_.joints[j].frame.relative_from_joint(joint_rotation(charts[j]));
  return joints;
}

FigurePose WholeBody::inside(FigurePose figure, double margin) const {
  for (int j = 0; j < kJointCount; ++j)
    if (!body_.joints[j].fused) figure.joints[j] = kept_inside(range_.joints[j], figure.joints[j], margin);
  return figure;
}

void WholeBody::add_balance(const PoseGoals& goals, const BodyPose& segments, Equations& equations) const {
  const Vec3 com = centre_of_mass(segments);
  const Vec2 at(com.x(), com.z());
  std::vector<Vec2> ways;
  for (const std::vector<Vec2>& support : goals.supports)
    if (const Vec2 way = way_into(support, at); way.norm() > 1e-6) ways.push_back(way);
  if (ways.empty() && !goals.balance) return;
  const Row along_x = weight_row(body_, segments, 0), along_z = weight_row(body_, segments, 2);
  const auto add = [&](const Vec2& want, double weight) {
    equations.add(along_x, want.x(), weight);
    equations.add(along_z, want.y(), weight);
  };
  for (const Vec2& way : ways) add(way, goals.support_weight);
  if (goals.balance) add(*goals.balance - at, goals.balance_weight);
}

void WholeBody::add_likeness(const PoseGoals& goals, const FigurePose& figure, const BodyPose& segments,
                             Equations& equations) const {
  equations.hold(0, goals.likeness.place - figure.place, goals.place_weight);
  equations.hold(3, log_rotation(goals.likeness.turn * figure.turn.conjugate()),
                 Vec3::Constant(goals.turn_weight));
  for (int j = 0; j < kJointCount; ++j) {
    if (body_.joints[j].fused) continue;
    const Quat& parent = segments[index(parent_of(joint_at(j)))].rotation;
    const auto hold = [&](const Quat& target, double weight) {
      equations.hold(column(joint_at(j)), parent * log_rotation(target * figure.joints[j].conjugate()),
                     Vec3::Constant(weight));
    };
    hold(goals.likeness.joints[j], goals.likeness_weight[j]);
    const Quat kept = kept_inside(range_.joints[j], figure.joints[j], goals.margin);
    if (!kept.isApprox(figure.joints[j], 0.0)) hold(kept, kLimitWeight);
  }
}

void WholeBody::add_point(const PointGoal& goal, const BodyPose& segments, Equations& equations) const {
  const Vec3 place = segments[index(goal.segment)] * goal.point;
  const Chain chain(body_, goal.segment);
  for (int axis = 0; axis < 3; ++axis)
    if (goal.weight[axis] > 0.0)
      equations.add(point_row(chain, segments, axis, place), goal.target[axis] - place[axis],
                    goal.weight[axis]);
}

void WholeBody::add_floor(const PoseGoals& goals, const BodyPose& segments, Equations& equations) const {
  const auto lift = [&](Segment segment, const Low& low, double height_m, double weight) {
    Vec3 target = segments[index(segment)] * low.point;
    target.y() = height_m;
    add_point({segment, low.point, target, weight * Vec3::UnitY()}, segments, equations);
  };
  for (int s = 0; s < kSegmentCount; ++s) {
    const Low low = lowest_of(segments[s], skin_[s]);
    if (low.height >= goals.floor_m) continue;
    lift(segment_at(s), low, goals.floor_m, goals.floor_weight);
    const Low other = lowest_of(segments[s], skin_[s], &low.point);
    if (other.height < goals.floor_m) lift(segment_at(s), other, goals.floor_m, goals.floor_weight);
  }
  for (const TouchGoal& goal : goals.touches) {
    Segment touching = Segment::pelvis;
    Low low;
    for (int s = 0; s < kSegmentCount; ++s)
      if (const Low here = lowest_of(segments[s], (*goal.points)[s]); here.height < low.height)
        low = here, touching = segment_at(s);
    if (std::isfinite(low.height)) lift(touching, low, goal.height_m, goal.weight);
  }
}

void WholeBody::add_goals(const PoseGoals& goals, const FigurePose& figure, Equations& equations) const {
  const BodyPose segments = segments_of(body_, figure);
  add_likeness(goals, figure, segments, equations);
  for (const PointGoal& goal : goals.points) add_point(goal, segments, equations);
  for (const TurnGoal& goal : goals.turns)
    add_turn(body_, goal.segment,
             log_rotation(goal.target * segments[index(goal.segment)].rotation.conjugate()), goal.weight,
             equations);
  for (const AxisGoal& goal : goals.axes)
    add_turn(
        body_, goal.segment,
        log_rotation(shortest_rotation(segments[index(goal.segment)].rotation * goal.axis, goal.direction)),
        goal.weight, equations);
  add_floor(goals, segments, equations);
  add_balance(goals, segments, equations);
}

FigurePose WholeBody::stepped(const FigurePose& figure, const Equations& equations, double damping) const {
  Normal a = equations.a;
  a.diagonal().array() += damping;
  Variables change = Eigen::LLT<Eigen::Ref<Normal>>(a).solve(equations.b);
  const double longest = change.cwiseAbs().maxCoeff();
  if (longest > kLongestStep) change *= kLongestStep / longest;
  const BodyPose segments = segments_of(body_, figure);
  FigurePose next = figure;
  next.place += change.head<3>();
  next.turn = (exp_rotation(change.segment<3>(3)) * figure.turn).normalized();
  for (int j = 0; j < kJointCount; ++j) {
    if (body_.joints[j].fused) continue;
    const Quat& parent = segments[index(parent_of(joint_at(j)))].rotation;
    const Vec3 turn = parent.conjugate() * Vec3(change.segment<3>(column(joint_at(j))));
    next.joints[j] = (exp_rotation(turn) * figure.joints[j]).normalized();
  }
  return next;
}

FigurePose WholeBody::reach(const PoseGoals& goals, FigurePose figure, int steps) const {
  double damping = kDamping;
  Equations both[2];
  int now = 0;
  add_goals(goals, figure, both[now]);
  for (int step = 0; step < steps; ++step) {
    const FigurePose next = stepped(figure, both[now], damping);
    Equations& there = both[1 - now];
    there = Equations();
    add_goals(goals, next, there);
    const double gain = both[now].cost - there.cost;
    if (gain < 0.0) {
      damping *= 10.0;
      continue;
    }
    figure = next;
    now = 1 - now;
    damping = std::max(kDamping, 0.2 * damping);
    if (gain < kSmallestGain * there.cost) break;
  }
  return figure;
}

std::vector<Vec2> hull_of(std::vector<Vec2> points) {
  if (points.size() < 3) return points;
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vec2> hull;
  const auto add = [&](const Vec2& point, std::size_t keep) {
    while (hull.size() > keep && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0.0)
      hull.pop_back();
    hull.push_back(point);
  };
  for (const Vec2& point : points) add(point, 1);
  const std::size_t lower = hull.size();
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

Vec2 way_into(const std::vector<Vec2>& hull, const Vec2& point) {
  if (hull.empty()) return Vec2::Zero();
  bool within = hull.size() > 2;
  Vec2 best = hull.front();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2& a = hull[i];
    const Vec2& b = hull[(i + 1) % hull.size()];
    if (cross(b - a, point - a) < 0.0) within = false;
    const Vec2 near = nearest_on_line(a, b, point);
    if ((near - point).norm() < (best - point).norm()) best = near;
  }
  return within ? Vec2(Vec2::Zero()) : Vec2(best - point);
}

std::vector<Vec2> drawn_in(const std::vector<Vec2>& hull, double margin) {
  Vec2 middle = Vec2::Zero();
  for (const Vec2& corner : hull) middle += corner / static_cast<double>(hull.size());
  std::vector<Vec2> inner;
  for (const Vec2& corner : hull) {
    const double away = (corner - middle).norm();
    inner.push_back(away > margin ? Vec2(middle + (1.0 - margin / away) * (corner - middle)) : middle);
  }
  return inner;
}

}  // namespace ukemi
