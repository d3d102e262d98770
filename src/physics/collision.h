// Shapes of the body, the props and the floor in ODE's collision space, found and made into contacts in a
// fixed order.
#pragma once

#include <optional>
#include <vector>

#include "physics/model.h"
#include "physics/senses.h"

namespace ukemi {

/// What touches what.
enum class PairKind { floor, prop, self };

struct ContactSettings {
  bool sparse_friction = true;  // friction rows only where they matter, see touch()
  double friction = 0.8;
  bool firm_soles = false;                             // soles on the floor do not slip
  std::optional<double> sole_friction = std::nullopt;  // in place of both
  PerSegment<bool> glides{};                           // without friction on the floor
};

/// Contacts of one moment: plain data, so that a rejected step can use them again.
struct Contacts {
  struct Point {
    std::size_t pair = 0;
    Vec3 place = Vec3::Zero();   // world, m
    Vec3 normal = Vec3::Zero();  // unit, into the first shape
    double depth = 0.0;          // m
    dGeomID a = nullptr, b = nullptr;
  };
  std::vector<Point> points;
  std::vector<double> depth;    // deepest point of each pair, m; 0 where apart
  std::vector<double> overlap;  // the same with what was accepted of it at the start
  double floor_penetration = 0.0, self_penetration = 0.0;
  bool ground = false;  // the body touches the floor
};

class Collision {
 public:
  Collision(OdeWorld& world, const Model& model, const ArticulatedBody& body, bool self_collision);
  ~Collision();
  Collision(const Collision&) = delete;
  Collision& operator=(const Collision&) = delete;

  /// Something that meets the body, the floor and earlier props. Takes the geom over; it moves with `body`,
  /// or stands where it is (nullptr).
  void add_prop(dGeomID geom, dBodyID body);
  /// Overlaps of the present pose that are no contact: shapes that fit a character may overlap at the start.
  void accept_overlaps();
  /// Shapes that have come out of the floor collide with it from then on. Call after an accepted step.
  void forget_overlaps(const Contacts& present);
  /// `whole_soles`: with every corner of the soles, so that a standing foot does not rock.
  Contacts find(bool whole_soles = false) const;
  bool is_floor(std::size_t pair) const { return pairs_[pair].kind == PairKind::floor; }
  /// The same as the body feels them.
  std::vector<SegmentContact> felt(const Contacts& contacts) const;
  /// Creates the contact joints of a step.
  void touch(const Contacts& contacts, const ContactSettings& settings) const;
  /// Where a probe that comes along `direction` from `start` first touches the body, and which segment;
  /// nothing if it passes by within `reach`. The probe is the caller's.
  struct FirstTouch {
    double distance;  // from `start` to the probe's centre
    Segment segment;
  };
  std::optional<FirstTouch> first_touch(dGeomID probe, const Vec3& start, const Vec3& direction,
                                        double reach) const;

 private:
  struct Collider {
    dGeomID geom = nullptr;
    int body = -1;  // of the model; -1 floor or prop
    Segment segment = Segment::pelvis;
    bool box = false;
    std::vector<Vec3> points{};  // frame of the body, m: the whole shape; it collides with the floor only
  };
  struct Pair {
    std::size_t a = 0, b = 0;
    PairKind kind = PairKind::self;
    double accepted = 0.0;  // overlap at the start, m
  };
  void add_shape(const Model& model, Segment segment, const Shape& shape);
  void add_floor_points(const Model& model, Segment segment, const std::vector<Vec3>& points);
  void make_self_pairs();

  OdeWorld& world_;
  std::vector<Collider> colliders_;  // 0: floor
  std::vector<Pair> pairs_;
};

}  // namespace ukemi
