// Senses made by hand: a standing man, turned and set in motion as a test likes.
#pragma once

#include "behave/fall_body.h"
#include "body/muscles.h"
#include "simulate/standing_man.h"

namespace ukemi::test {

struct Faller {
  StandingMan man;
  MuscleStrength strength;

  Faller() {
    auto loaded = muscle_strength(man.body, Sex::male, 1.0);
    EXPECT_TRUE(loaded);
    strength = *loaded;
  }
  FallBody body() const { return {man.body, man.range, strength}; }

  /// The man stiff as a plank, turned by `turn` about the floor below him, moving with `velocity`.
  Senses senses(const Vec3& turn, const Vec3& velocity, double time_s = 0.0) const {
    Senses s;
    s.time_s = time_s;
    const Rigid tip{exp_rotation(turn), Vec3::Zero()};
    double mass = 0.0;
    for (int i = 0; i < kSegmentCount; ++i) {
      s.pose[i] = tip * man.segments[i];
      s.centre[i] = s.pose[i] * man.body.segments[i].centre_of_mass;
      s.velocity[i] = velocity;
      s.com += man.body.segments[i].mass_kg * s.centre[i];
      mass += man.body.segments[i].mass_kg;
    }
    s.com /= mass;
    s.com_velocity = velocity;
    s.fastest_m_s = velocity.norm();
    return s;
  }
};

/// The other side's senses: left and right exchanged, z turned round.
inline Vec3 mirrored(const Vec3& v) { return {v.x(), v.y(), -v.z()}; }
inline Vec3 mirrored_spin(const Vec3& v) { return {-v.x(), -v.y(), v.z()}; }
inline Quat mirrored(const Quat& q) { return {q.w(), -q.x(), -q.y(), q.z()}; }
inline Senses mirrored(const Senses& s) {
  Senses m = s;
  for (int i = 0; i < kSegmentCount; ++i) {
    const int o = index(mirror_of(segment_at(i)));
    m.pose[i] = {mirrored(s.pose[o].rotation), mirrored(s.pose[o].translation)};
    m.centre[i] = mirrored(s.centre[o]);
    m.velocity[i] = mirrored(s.velocity[o]);
    m.angular_velocity[i] = mirrored_spin(s.angular_velocity[o]);
  }
  m.com = mirrored(s.com);
  m.com_velocity = mirrored(s.com_velocity);
  for (SegmentContact& c : m.contacts) {
    c.segment = mirror_of(c.segment);
    c.place = mirrored(c.place);
    c.normal = mirrored(c.normal);
  }
  return m;
}

inline SegmentContact touches_floor(const Senses& s, Segment segment) {
  return {segment, SegmentContact::With::floor, s.pose[index(segment)].translation, Vec3::UnitY(), 0.001};
}

}  // namespace ukemi::test
