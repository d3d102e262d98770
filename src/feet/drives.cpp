#include "feet/drives.h"

#include <array>

namespace ukemi {
namespace {

// N m at an error of kFullAt, of a man of 73 kg and 1.741 m.
constexpr double kTorque[kJointCount] = {220.0, 160.0, 40.0,  70.0,  70.0,  60.0,  12.0,  70.0, 70.0,
                                         60.0,  12.0,  230.0, 230.0, 150.0, 230.0, 230.0, 150.0};
constexpr double kFullAt = 0.35;  // rad
constexpr double kEccentric = 1.2;
constexpr double kUncapped_n_m = 1e6;  // the joint's own strength caps what is asked

constexpr std::array<double, 3> kSwinging = {2.0, 2.0, 0.8};  // share of the stiffness: hip, knee, ankle
constexpr double kSwingDamping_s = 0.10;
// N m at knee and ankle of a leg in the air, of a man of 73 kg and 1.741 m. All that a knee can give (250)
// throws the thigh back, against a hip that gives 180. Of 60 walks 29 go on without this bound, 36 with
// 50 at the knee, 38 with 75; of 360 blows to bodies that stand 73 % stay up without, 76 % with.
constexpr double kSwingingKnee = 75.0, kSwingingFoot = 30.0;

void ask_at_most(const Physique& physique, Joint joint, double most_n_m, Goals& goals) {
  for (JointGoal& goal : goals.joints[index(joint)]) {
    goal.least_n_m.setConstant(-most_n_m * physique.strength);
    goal.most_n_m.setConstant(most_n_m * physique.strength);
  }
}

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

void ask_swinging_leg(const Physique& physique, double strength, const Leg& leg, const Senses& senses,
                      const LegPosture& now, const LegPosture& soon, Goals& goals) {
  const std::array<Joint, 3> joints = {leg.hip, leg.knee, leg.ankle};
  const std::array<Segment, 3> parents = {Segment::pelvis, leg.thigh, leg.shank};
  const std::array<Quat, 3> wanted = {now.thigh, now.shank, now.foot};
  const std::array<Quat, 3> next = {soon.thigh, soon.shank, soon.foot};
  for (int k = 0; k < 3; ++k) {
    const int parent = index(parents[k]);
    const Vec3 omega =
        log_rotation(next[k] * wanted[k].conjugate()) / kAhead_s - senses.angular_velocity[parent];
    ask_joint(physique, strength, joints[k],
              {senses.pose[parent].rotation.conjugate() * wanted[k], omega,
               -physique.weight_torque(senses, joints[k]), kSwinging[k], kSwingDamping_s * physique.tempo},
              goals);
  }
  ask_at_most(physique, leg.knee, kSwingingKnee, goals);
  ask_at_most(physique, leg.ankle, kSwingingFoot, goals);
  goals.glides[index(leg.foot)] = true;
}

}  // namespace ukemi
