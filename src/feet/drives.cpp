#include "feet/drives.h"

namespace ukemi {
namespace {

// N m at an error of kFullAt, of a man of 73 kg and 1.741 m.
constexpr double kTorque[kJointCount] = {220.0, 160.0, 40.0,  70.0,  70.0,  60.0,  12.0,  70.0, 70.0,
                                         60.0,  12.0,  230.0, 230.0, 150.0, 230.0, 230.0, 150.0};
constexpr double kFullAt = 0.35;  // rad
constexpr double kEccentric = 1.2;
constexpr double kUncapped_n_m = 1e6;  // the joint's own strength caps what is asked

}  // namespace

void ask_joint(const Physique& physique, double strength, Joint joint, const Drive& drive, Goals& goals) {
  if (physique.fused[index(joint)]) return;
  JointGoal asked;
  asked.parent_from_child = drive.goal;
  asked.velocity = drive.velocity;
  asked.feed_forward_n_m = drive.feed_forward;
  asked.stiffness_n_m_rad =
      drive.share * kTorque[index(joint)] * kEccentric * physique.strength * strength / kFullAt;
  asked.damping_n_m_s_rad = asked.stiffness_n_m_rad * drive.damping_s;
  asked.least_n_m.setConstant(-kUncapped_n_m);
  asked.most_n_m.setConstant(kUncapped_n_m);
  goals.joints[index(joint)].push_back(asked);
}

}  // namespace ukemi
