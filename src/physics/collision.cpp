#include "physics/collision.h"

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ukemi {
namespace {

constexpr int kMaxContacts = 4;
constexpr int kMaxBoxContacts = 3;        // a fourth adds nothing but rows
constexpr int kFullFrictionContacts = 2;  // of a pair
constexpr double kNear = 0.005;           // m: points this near to one another carry as one
constexpr double kPointRadius = 1e-3;     // m; never asked for
constexpr double kSoftErp = 0.2;
constexpr double kSoftCfm = 1e-5;

/// Joints between two segments along the tree.
int tree_distance(Segment a, Segment b) {
  int steps = 0;
  while (a != b) {
    if (index(a) < index(b)) std::swap(a, b);
    a = parent_of(a);
    ++steps;
  }
  return steps;
}

bool pair_of(Segment a, Segment b, Segment x, Segment y) { return (a == x && b == y) || (a == y && b == x); }

bool may_collide(Segment a, Segment b) {
  const int distance = tree_distance(a, b);
  if (distance > 2) return true;
  return pair_of(a, b, Segment::thigh_l, Segment::thigh_r) ||
         pair_of(a, b, Segment::chest, Segment::upperarm_l) ||
         pair_of(a, b, Segment::chest, Segment::upperarm_r);
}

bool boxes_overlap(dGeomID a, dGeomID b) {
  dReal p[6];
  dReal q[6];
  dGeomGetAABB(a, p);
  dGeomGetAABB(b, q);
  return p[0] <= q[1] && q[0] <= p[1] && p[2] <= q[3] && q[2] <= p[3] && p[4] <= q[5] && q[4] <= p[5];
}

bool is_foot(Segment s) { return s == Segment::foot_l || s == Segment::foot_r; }

/// Of points below the floor (y = 0) the deepest, the one farthest from it, and the one farthest from the
/// line through both.
std::vector<Vec3> carrying_points(const std::vector<Vec3>& below) {
  std::vector<Vec3> chosen;
  const auto add_best = [&](auto&& value) {
    const auto best = std::max_element(below.begin(), below.end(),
                                       [&](const Vec3& a, const Vec3& b) { return value(a) < value(b); });
    if (best != below.end() && (chosen.empty() || value(*best) > kNear)) chosen.push_back(*best);
  };
  add_best([](const Vec3& p) { return -p.y(); });
  if (!chosen.empty()) add_best([&](const Vec3& p) { return (p - chosen[0]).norm(); });
  if (chosen.size() < 2) return chosen;
  const Vec3 along = (chosen[1] - chosen[0]).normalized();
  add_best([&](const Vec3& p) { return (p - chosen[0]).cross(along).norm(); });
  return chosen;
}

/// Contacts of points with the floor, as dCollide has them.
int points_on_floor(const std::vector<Vec3>& points, dGeomID floor, dGeomID geom,
                    std::array<dContactGeom, kMaxContacts>& contacts) {
  const Rigid world_from_body{quat(dBodyGetQuaternion(dGeomGetBody(geom))),
                              vec3(dBodyGetPosition(dGeomGetBody(geom)))};
  std::vector<Vec3> below;
  for (const Vec3& point : points)
    if (const Vec3 place = world_from_body * point; place.y() < 0.0) below.push_back(place);
  int count = 0;
  for (const Vec3& place : carrying_points(below)) {
    dContactGeom& contact = contacts[static_cast<std::size_t>(count++)];
    contact = {};
    contact.depth = -place.y();
    contact.g1 = floor;
    contact.g2 = geom;
    Eigen::Map<Vec3>(contact.pos) = place;
    Eigen::Map<Vec3>(contact.normal) = -Vec3::UnitY();
  }
  return count;
}

Vec3 velocity_at(dBodyID body, const dReal* point) {
  if (body == nullptr) return Vec3::Zero();
  dVector3 v;
  dBodyGetPointVel(body, point[0], point[1], point[2], v);
  return vec3(v);
}

}  // namespace

Collision::Collision(OdeWorld& world, const Model& model, const ArticulatedBody& body, bool self_collision)
    : world_(world) {
  colliders_.push_back({dCreatePlane(nullptr, 0, 1, 0, 0), -1, Segment::pelvis, false});
  for (int s = 0; s < kSegmentCount; ++s)
    for (const Shape& shape : body.segments[s].shapes) add_shape(model, segment_at(s), shape);
  for (int s = 0; s < kSegmentCount; ++s)
    if (!body.segments[s].floor_points.empty())
      add_floor_points(model, segment_at(s), body.segments[s].floor_points);
  for (std::size_t i = 1; i < colliders_.size(); ++i) pairs_.push_back({0, i, PairKind::floor, 0.0});
  if (self_collision) make_self_pairs();
}

Collision::~Collision() {
  for (const Collider& collider : colliders_)
    if (world_.poisoned())
      keep_for_ever(collider.geom);
    else
      dGeomDestroy(collider.geom);
}

void Collision::add_shape(const Model& model, Segment segment, const Shape& shape) {
  Rigid body_from_geom = model.segment_in_body(segment) * shape.segment_from_shape;
  Collider collider{nullptr, model.body_of(segment), segment, shape.kind == ShapeKind::box};
  if (shape.kind == ShapeKind::box) {
    collider.geom = dCreateBox(nullptr, shape.size.x(), shape.size.y(), shape.size.z());
  } else {
    collider.geom = dCreateCapsule(nullptr, shape.radius, shape.length);  // along its z, ours along y
    body_from_geom.rotation = body_from_geom.rotation * exp_rotation(Vec3(-0.5 * kPi, 0.0, 0.0));
  }
  dGeomSetBody(collider.geom, model.bodies()[collider.body].id);
  const Vec3& p = body_from_geom.translation;
  const Quat& q = body_from_geom.rotation;
  const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
  dGeomSetOffsetPosition(collider.geom, p.x(), p.y(), p.z());
  dGeomSetOffsetQuaternion(collider.geom, rotation);
  colliders_.push_back(collider);
}

void Collision::add_floor_points(const Model& model, Segment segment, const std::vector<Vec3>& points) {
  Collider collider{dCreateSphere(nullptr, kPointRadius), model.body_of(segment), segment, false, points};
  for (Vec3& point : collider.points) point = model.segment_in_body(segment) * point;
  dGeomSetBody(collider.geom, model.bodies()[collider.body].id);
  colliders_.push_back(std::move(collider));
}

void Collision::make_self_pairs() {
  for (std::size_t a = 1; a < colliders_.size(); ++a)
    for (std::size_t b = a + 1; b < colliders_.size(); ++b)
      if (colliders_[a].body != colliders_[b].body && colliders_[a].points.empty() &&
          colliders_[b].points.empty() && may_collide(colliders_[a].segment, colliders_[b].segment))
        pairs_.push_back({a, b, PairKind::self, 0.0});
}

void Collision::add_prop(dGeomID geom, dBodyID body) {
  if (body != nullptr) dGeomSetBody(geom, body);
  const std::size_t i = colliders_.size();
  const bool box = dGeomGetClass(geom) == dBoxClass;
  colliders_.push_back({geom, -1, Segment::pelvis, box});
  for (std::size_t other = body == nullptr ? 1 : 0; other < i; ++other)
    if (colliders_[other].points.empty()) pairs_.push_back({other, i, PairKind::prop, 0.0});
}

void Collision::accept_overlaps() {
  const Contacts now = find();
  for (std::size_t p = 0; p < pairs_.size(); ++p) pairs_[p].accepted += now.depth[p];
}

void Collision::forget_overlaps(const Contacts& present) {
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (is_floor(p)) pairs_[p].accepted = std::min(pairs_[p].accepted, present.overlap[p]);
}

Contacts Collision::find(bool whole_soles) const {
  Contacts found;
  found.depth.assign(pairs_.size(), 0.0);
  found.overlap.assign(pairs_.size(), 0.0);
  std::array<dContactGeom, kMaxContacts> buffer;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const Pair& pair = pairs_[p];
    const Collider& a = colliders_[pair.a];
    const Collider& b = colliders_[pair.b];
    if (pair.a != 0 && !boxes_overlap(a.geom, b.geom)) continue;
    const bool sole = whole_soles && pair.kind == PairKind::floor && is_foot(b.segment);
    const int most = (a.box || b.box) && !sole ? kMaxBoxContacts : kMaxContacts;
    const int count = b.points.empty() ? dCollide(a.geom, b.geom, most, buffer.data(), sizeof(dContactGeom))
                                       : points_on_floor(b.points, a.geom, b.geom, buffer);
    for (int i = 0; i < count; ++i) {
      const dContactGeom& touch = buffer[i];
      found.overlap[p] = std::max(found.overlap[p], touch.depth);
      const double depth = touch.depth - pair.accepted;
      if (depth <= 0.0) continue;
      found.points.push_back({p, vec3(touch.pos), vec3(touch.normal), depth, touch.g1, touch.g2});
      found.depth[p] = std::max(found.depth[p], depth);
    }
    if (pair.kind == PairKind::self)
      found.self_penetration = std::max(found.self_penetration, found.depth[p]);
    if (pair.kind != PairKind::floor || found.depth[p] <= 0.0) continue;
    found.floor_penetration = std::max(found.floor_penetration, found.depth[p]);
    found.ground = true;
  }
  return found;
}

void Collision::touch(const Contacts& contacts, const ContactSettings& settings) const {
  std::size_t last_pair = pairs_.size();
  int nth = 0;
  for (const Contacts::Point& point : contacts.points) {
    nth = point.pair == last_pair ? nth + 1 : 0;
    last_pair = point.pair;
    dContact contact{};
    contact.geom.depth = point.depth;
    contact.geom.g1 = point.a;
    contact.geom.g2 = point.b;
    Eigen::Map<Vec3>(contact.geom.pos) = point.place;
    Eigen::Map<Vec3>(contact.geom.normal) = point.normal;
    dSurfaceParameters& surface = contact.surface;
    surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
    surface.soft_erp = kSoftErp;
    surface.soft_cfm = kSoftCfm;
    surface.mu = settings.friction;
    const Pair& pair = pairs_[point.pair];
    const dBodyID a = dGeomGetBody(point.a);
    const dBodyID b = dGeomGetBody(point.b);
    const bool sole = pair.kind == PairKind::floor && is_foot(colliders_[pair.b].segment);
    if (sole && settings.sole_friction) surface.mu = *settings.sole_friction;
    if (settings.sparse_friction) {
      if (pair.kind == PairKind::floor) {
        // Two rows at the first two contacts of a pair hold it; the others only carry.
        if (nth >= kFullFrictionContacts)
          surface.mu = 0.0;
        else if (settings.firm_soles && sole && !settings.sole_friction)
          surface.mu = dInfinity;
      } else {
        // One row along the slip.
        Vec3 slip = velocity_at(a, contact.geom.pos) - velocity_at(b, contact.geom.pos);
        slip -= point.normal.dot(slip) * point.normal;
        if (slip.norm() < 1e-6) slip = point.normal.unitOrthogonal();
        slip.normalize();
        surface.mode |= dContactAxisDep | dContactFDir1;
        surface.mu2 = 0.0;
        contact.fdir1[0] = slip.x();
        contact.fdir1[1] = slip.y();
        contact.fdir1[2] = slip.z();
      }
    }
    if (sole && settings.glides[index(colliders_[pair.b].segment)]) surface.mu = 0.0;
    dJointAttach(dJointCreateContact(world_.id(), world_.contacts(), &contact), a, b);
  }
}

std::vector<SegmentContact> Collision::felt(const Contacts& contacts) const {
  std::vector<SegmentContact> felt;
  felt.reserve(contacts.points.size());
  for (const Contacts::Point& point : contacts.points) {
    const Pair& pair = pairs_[point.pair];
    using With = SegmentContact::With;
    const With with = pair.kind == PairKind::floor  ? With::floor
                      : pair.kind == PairKind::prop ? With::prop
                                                    : With::self;
    // The normal points into point.a's shape.
    for (const std::size_t i : {pair.a, pair.b}) {
      const Collider& collider = colliders_[i];
      if (collider.body < 0) continue;
      const Vec3 normal = collider.geom == point.a ? point.normal : Vec3(-point.normal);
      felt.push_back({collider.segment, with, point.place, normal, point.depth});
    }
  }
  return felt;
}

std::optional<Collision::FirstTouch> Collision::first_touch(dGeomID probe, const Vec3& start,
                                                            const Vec3& direction, double reach) const {
  constexpr double kStride = 0.002;
  std::optional<FirstTouch> found;
  const auto touched = [&](double distance) {
    const Vec3 at = start + distance * direction;
    dGeomSetPosition(probe, at.x(), at.y(), at.z());
    dContactGeom contact;
    for (const Collider& collider : colliders_) {
      if (collider.body < 0 || !collider.points.empty()) continue;
      if (!boxes_overlap(probe, collider.geom)) continue;
      if (dCollide(probe, collider.geom, 1, &contact, sizeof contact) > 0) {
        found = FirstTouch{distance, collider.segment};
        return true;
      }
    }
    return false;
  };
  double distance = 0.0;
  while (distance <= reach && !touched(distance)) distance += kStride;
  if (!found) return std::nullopt;
  double outside = std::max(0.0, distance - kStride);
  double inside = distance;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (outside + inside);
    (touched(middle) ? inside : outside) = middle;
  }
  found->distance = inside;
  return found;
}

}  // namespace ukemi
