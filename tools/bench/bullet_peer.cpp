#include "bullet_peer.h"

#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "physics/physics.h"
#include "stopwatch.h"

namespace ukemi {
namespace {

constexpr double kStep_s = 1e-3;
constexpr double kFriction = 0.8;  // as ours; Bullet multiplies those of both bodies
constexpr double kGravity = 9.81;
const double kOneDegree = radians(1.0);

btVector3 bt(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}
btQuaternion bt(const Quat& q) {
  return {static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
          static_cast<btScalar>(q.w())};
}
btTransform bt(const Rigid& pose) { return btTransform(bt(pose.rotation), bt(pose.translation)); }
Vec3 vec(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Quat quat_of(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// What Bullet is given for a range. A cone about the middle of the range's bounding box: rotations about y
/// and z form an ellipse as wide as the box. Elbows and knees, whose cones would be slits, are hinges about z
/// with the twist of the start, as in Bullet's own ragdoll.
struct Limit {
  Quat joint_from_limit = Quat::Identity();          // cone: the middle
  double about_y = 0.0, about_z = 0.0, twist = 0.0;  // cone: half widths, rad
  bool hinge = false;
  double low = 0.0, high = 0.0, start_twist = 0.0;  // hinge
};

bool is_hinge(Joint joint) {
  return joint == Joint::elbow_l || joint == Joint::elbow_r || joint == Joint::knee_l ||
         joint == Joint::knee_r;
}

Limit limit_of(const ModelJoint& joint, const SwingTwist& start) {
  Eigen::AlignedBox2d box;
  for (const Vec2& corner : joint.range.polygon) box.extend(corner);
  Limit limit;
  limit.hinge = is_hinge(joint.joint);
  limit.low = box.min().y();
  limit.high = box.max().y();
  limit.start_twist = start.twist;
  limit.about_y = 0.5 * box.sizes().x();
  limit.about_z = 0.5 * box.sizes().y();
  limit.twist = 0.5 * (joint.range.twist_max - joint.range.twist_min);
  if (!limit.hinge)
    limit.joint_from_limit =
        joint_rotation({box.center(), 0.5 * (joint.range.twist_min + joint.range.twist_max)});
  return limit;
}

/// How far a rotation lies outside what Bullet was given, rad: the largest of the angles' excesses, that of a
/// cone's swing along its direction. Bullet's ellipse turns with the child.
double excess_of(const Limit& limit, const Quat& joint) {
  const Quat turned = limit.joint_from_limit.conjugate() * joint;
  const SwingTwist chart = swing_twist((limit.hinge ? turned : turned.conjugate()).normalized());
  const Vec2& a = chart.swing;
  if (limit.hinge)
    return std::max(
        {std::abs(a.x()), a.y() - limit.high, limit.low - a.y(), std::abs(chart.twist - limit.start_twist)});
  const double share = Vec2(a.x() / limit.about_y, a.y() / limit.about_z).norm();
  const double outside = share > 1.0 ? a.norm() * (1.0 - 1.0 / share) : 0.0;
  return std::max(outside, std::abs(chart.twist) - limit.twist);
}

struct Link {
  std::unique_ptr<btCompoundShape> compound;
  std::unique_ptr<btRigidBody> body;
  Quat body_from_principal;  // Bullet's inertias are diagonal
};

class BulletWorld {
 public:
  BulletWorld(const Prepared& prepared, const Scene& scene, const Physics& physics)
      : model_(physics.model()),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    world_.setGravity({0, static_cast<btScalar>(-kGravity), 0});
    add_body(Vec3::Zero(), 0.0, Vec3::Zero(), &floor_, Rigid());
    for (std::size_t b = 0; b < model_.bodies().size(); ++b) add_link(prepared.body, b);
    for (const ModelJoint& joint : model_.joints()) add_joint(joint);
    ignore_neighbours();
    add_ball(scene, physics.prop_poses().front());
  }
  ~BulletWorld() {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : others_) world_.removeRigidBody(body.get());
    for (const Link& link : links_) world_.removeRigidBody(link.body.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void run(double duration_s, Sample& sample) {
    const long steps = std::lround(duration_s / kStep_s);
    for (long step = 0; step < steps; ++step) {
      const double before = thread_seconds();
      world_.stepSimulation(static_cast<btScalar>(kStep_s), 0);
      sample.cpu_s += thread_seconds() - before;
      observe(sample);
    }
    sample.steps = sample.calls = steps;
    sample.engine_s = sample.cpu_s;
    sample.rested =
        std::none_of(links_.begin(), links_.end(), [](const Link& link) { return link.body->isActive(); });
  }

 private:
  std::unique_ptr<btRigidBody> make_body(const Vec3& velocity, double mass_kg, const Vec3& inertia,
                                         btCollisionShape* shape, const Rigid& pose) {
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass_kg), nullptr, shape,
                                                  bt(inertia));
    info.m_startWorldTransform = bt(pose);
    info.m_friction = static_cast<btScalar>(std::sqrt(kFriction));
    auto body = std::make_unique<btRigidBody>(info);
    body->setLinearVelocity(bt(velocity));
    world_.addRigidBody(body.get());
    return body;
  }

  void add_body(const Vec3& velocity, double mass_kg, const Vec3& inertia, btCollisionShape* shape,
                const Rigid& pose) {
    others_.push_back(make_body(velocity, mass_kg, inertia, shape, pose));
  }

  void add_shapes(const ArticulatedBody& body, int host, Link& link) {
    const Rigid principal_from_body{link.body_from_principal.conjugate(), Vec3::Zero()};
    for (int s = 0; s < kSegmentCount; ++s) {
      if (model_.body_of(segment_at(s)) != host) continue;
      for (const Shape& shape : body.segments[s].shapes) {
        if (shape.kind == ShapeKind::box)
          shapes_.push_back(std::make_unique<btBoxShape>(bt(Vec3(0.5 * shape.size))));
        else
          shapes_.push_back(std::make_unique<btCapsuleShape>(static_cast<btScalar>(shape.radius),
                                                             static_cast<btScalar>(shape.length)));
        link.compound->addChildShape(
            bt(principal_from_body * model_.segment_in_body(segment_at(s)) * shape.segment_from_shape),
            shapes_.back().get());
      }
    }
  }

  void add_link(const ArticulatedBody& body, std::size_t b) {
    const ModelBody& part = model_.bodies()[b];
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(part.inertia);
    Mat3 axes = solver.eigenvectors();
    if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
    Link link{std::make_unique<btCompoundShape>(), nullptr, Quat(axes).normalized()};
    add_shapes(body, static_cast<int>(b), link);
    const RigidState state = read_state(part.id);
    link.body = make_body(state.linear_velocity, part.mass_kg, solver.eigenvalues(), link.compound.get(),
                          {state.rotation * link.body_from_principal, state.position});
    links_.push_back(std::move(link));
  }

  btTransform frame(int body, const Vec3& anchor, const Quat& rotation) const {
    const Quat principal_from_body = links_[static_cast<std::size_t>(body)].body_from_principal.conjugate();
    return bt(Rigid{principal_from_body * rotation, principal_from_body * anchor});
  }

  /// Bullet turns a cone's twist about its second body's link.
  void add_joint(const ModelJoint& joint) {
    const Limit limit = limit_of(joint, model_.chart(joint));
    btRigidBody& parent = *links_[static_cast<std::size_t>(joint.parent)].body;
    btRigidBody& child = *links_[static_cast<std::size_t>(joint.child)].body;
    const btTransform in_parent =
        frame(joint.parent, joint.anchor_in_parent, joint.parent_from_joint * limit.joint_from_limit);
    Quat child_from_limit = joint.joint_from_child_neutral;
    if (limit.hinge) child_from_limit = child_from_limit * exp_rotation(Vec3(-limit.start_twist, 0.0, 0.0));
    const btTransform in_child = frame(joint.child, joint.anchor_in_child, child_from_limit);
    if (limit.hinge) {
      auto hinge = std::make_unique<btHingeConstraint>(parent, child, in_parent, in_child, true);
      hinge->setLimit(static_cast<btScalar>(limit.low), static_cast<btScalar>(limit.high));
      joints_.push_back(std::move(hinge));
    } else {
      auto cone = std::make_unique<btConeTwistConstraint>(parent, child, in_parent, in_child);
      cone->setLimit(static_cast<btScalar>(limit.about_z), static_cast<btScalar>(limit.about_y),
                     static_cast<btScalar>(limit.twist));
      joints_.push_back(std::move(cone));
    }
    world_.addConstraint(joints_.back().get(), true);
    limits_.push_back(limit);
  }

  bool are_neighbours(int a, int b) const {
    const auto parent = [&](int body) {
      for (const ModelJoint& joint : model_.joints())
        if (joint.child == body) return joint.parent;
      return -1;
    };
    return parent(a) == b || parent(b) == a || parent(parent(a)) == b || parent(parent(b)) == a ||
           parent(a) == parent(b);
  }

  struct Touched : btCollisionWorld::ContactResultCallback {
    bool any = false;
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      any = any || point.getDistance() < 0;
      return 0;
    }
  };

  /// Segments next to one another, and those that overlap in the start pose, do not meet.
  void ignore_neighbours() {
    for (std::size_t a = 0; a < links_.size(); ++a)
      for (std::size_t b = a + 1; b < links_.size(); ++b) {
        Touched touched;
        world_.contactPairTest(links_[a].body.get(), links_[b].body.get(), touched);
        if (!touched.any && !are_neighbours(static_cast<int>(a), static_cast<int>(b))) continue;
        links_[a].body->setIgnoreCollisionCheck(links_[b].body.get(), true);
        links_[b].body->setIgnoreCollisionCheck(links_[a].body.get(), true);
      }
  }

  void add_ball(const Scene& scene, const Rigid& pose) {
    const double r = scene.ball_radius_m;
    shapes_.push_back(std::make_unique<btSphereShape>(static_cast<btScalar>(r)));
    add_body(scene.ball_speed_m_s * scene.direction, scene.ball_mass_kg,
             Vec3::Constant(0.4 * scene.ball_mass_kg * r * r), shapes_.back().get(), pose);
  }

  Rigid pose_of(int body) const {
    const Link& link = links_[static_cast<std::size_t>(body)];
    const btTransform& pose = link.body->getWorldTransform();
    return {(quat_of(pose.getRotation()) * link.body_from_principal.conjugate()).normalized(),
            vec(pose.getOrigin())};
  }

  void observe(Sample& sample) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const ModelJoint& joint = model_.joints()[j];
      const Rigid parent = pose_of(joint.parent);
      const Rigid child = pose_of(joint.child);
      const Quat rotation = joint.rotation(parent.rotation, child.rotation);
      const double outside = excess(joint.range, swing_twist(rotation));
      ++sample.samples;
      sample.over_1deg += outside > kOneDegree ? 1 : 0;
      sample.over_own_1deg += excess_of(limits_[j], rotation) > kOneDegree ? 1 : 0;
      sample.excess_max_deg = std::max(sample.excess_max_deg, degrees(outside));
      sample.separation_max_m =
          std::max(sample.separation_max_m,
                   Vec3(parent * joint.anchor_in_parent - child * joint.anchor_in_child).norm());
    }
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
      sample.contacts += dispatcher_.getManifoldByIndexInternal(i)->getNumContacts();
  }

  const Model& model_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btStaticPlaneShape floor_{btVector3(0, 1, 0), 0};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btRigidBody>> others_;  // floor, ball
  std::vector<Link> links_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<Limit> limits_;
};

}  // namespace

bool has_bullet() { return true; }

Sample bullet_sample(const Prepared& prepared, const Scene& scene, int hit, double duration_s) {
  Sample sample;
  sample.hit = hit;
  sample.run = sample.row = kBulletRun;
  Diagnostics diagnostics;
  Physics physics(prepared.body, prepared.range, prepared.thresholds, prepared.strength, prepared.start.state,
                  scene, PhysicsSettings{});
  physics.begin(diagnostics);
  BulletWorld world(prepared, scene, physics);
  world.run(duration_s, sample);
  return sample;
}

}  // namespace ukemi
