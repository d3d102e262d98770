#include "feet/flinch.h"

#include "body/on_ground.h"

namespace ukemi {

Flinch::Flinch(const FlinchSettings& settings, double yaw) : settings_(settings) {
  const Vec2 way = on_ground(settings.way);
  sideways_ = way.dot(right_of(yaw));
  forward_ = way.dot(forward_of(yaw));
}

double Flinch::course(double time_s) const {
  if (settings_.way.isZero()) return 0.0;
  return settings_.size * (min_jerk((time_s - settings_.begins_s) / settings_.rise_s) -
                           min_jerk((time_s - settings_.holds_until_s) / settings_.falls_s));
}

// Axes of a parent segment: x to the front (turning about it lowers the left, raises the right), z to the
// right (turning about it bends the trunk back and swings the limbs forward).
Vec3 Flinch::turn(Joint joint, double time_s) const {
  const double q = course(time_s);
  const double arm = is_left(joint) ? settings_.left_arm : settings_.right_arm;
  const double out = is_left(joint) ? 1.0 : -1.0;
  const auto turned = [q](double x_deg, double z_deg) {
    return Vec3(q * radians(x_deg), 0.0, q * radians(z_deg));
  };
  switch (joint) {
    case Joint::spine:
    case Joint::chest:
      return turned(3.5 * sideways_, -5.2);
    case Joint::neck:
      return turned(3.5 * sideways_, -10.0);
    case Joint::clavicle_l:
    case Joint::clavicle_r:
      return turned(8.0 * arm * out, 0.0);
    case Joint::shoulder_l:
    case Joint::shoulder_r:
      return turned(4.0 * arm * out, 8.0 * arm);
    case Joint::elbow_l:
    case Joint::elbow_r:
      return turned(0.0, 20.0 * arm);
    default:
      return Vec3::Zero();
  }
}

}  // namespace ukemi
