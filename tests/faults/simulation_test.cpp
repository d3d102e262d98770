// What no sane bake asks for: a finite clip or a clear refusal, and nothing of it in the next bake.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "humanoid/rotations.h"
#include "simulate/standing_man.h"

namespace ukemi {
namespace {

using test::StandingMan;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Everything that a simulation is given.
struct Request {
  ArticulatedBody body;
  RangeOfMotion range;
  StartState start;
  Scene scene;
  SimulationSettings settings;
};

Request request_of(const BodyPose& segments, double height_m, double mass_kg) {
  Character character;
  character.skeleton.nodes.push_back({"root", -1, {}});
  EXPECT_TRUE(character.skeleton.sort());
  Humanoid humanoid;
  humanoid.height_m = height_m;
  for (SegmentNodes& nodes : humanoid.segments) nodes.chain = {0};
  Diagnostics diagnostics;
  const auto body = build_body(character, humanoid, rest_pose(character.skeleton), segments,
                               BodyOptions{mass_kg, Sex::male}, diagnostics);
  EXPECT_TRUE(body);
  Request request{*body, *load_range_of_motion("human"), {}, {}, {}};
  request.start.segments = segments;
  request.scene.direction = Vec3(-1.0, 0.0, 0.0);
  request.settings.duration_s = 1.0;
  const auto charts = charts_of(request.range, rotations_of(segments));
  for (int j = 0; j < kJointCount; ++j) widen_to_hold(request.range.joints[j], charts[j], radians(3.0));
  return request;
}

/// The standing man, enlarged.
Request man(double height_m = 1.75, double mass_kg = 0.0) {
  BodyPose segments = StandingMan().segments;
  for (Rigid& segment : segments) segment.translation *= height_m / 1.75;
  return request_of(segments, height_m, mass_kg);
}

/// Every segment turned by `angle` about its own axis, in place.
Request twisted_man(double angle) {
  BodyPose segments = StandingMan().segments;
  for (int s = 0; s < kSegmentCount; ++s)
    segments[s].rotation =
        exp_rotation(angle * Vec3(std::sin(s), std::cos(2.0 * s), std::sin(3.0 * s)).normalized());
  return request_of(segments, 1.75, 0.0);
}

struct Fault {
  const char* name;
  std::function<Request()> request;
};

/// `man()` with one thing changed.
Fault changed(const char* name, const std::function<void(Request&)>& change) {
  return {name, [change] {
            Request request = man();
            change(request);
            return request;
          }};
}

std::vector<Fault> sizes_and_masses() {
  std::vector<Fault> faults = {
      {"OneGramAndTenCentimetres", [] { return man(0.1, 0.001); }},
      {"TenTonsAndTenCentimetres", [] { return man(0.1, 1e4); }},
      {"OneGramAndThirtyMetres", [] { return man(30.0, 0.001); }},
      {"TenTonsAndThirtyMetres", [] { return man(30.0, 1e4); }},
      {"ThirtyMetres", [] { return man(30.0); }},
      {"TenCentimetres", [] { return man(0.1); }},
      {"OneGram", [] { return man(1.75, 0.001); }},
      {"TenTons", [] { return man(1.75, 1e4); }},
      {"AllJointsInOnePoint", [] { return request_of(BodyPose{}, 1.75, 0.0); }},
  };
  faults.push_back(
      changed("AHeadOfTenTons", [](Request& r) { r.body.segments[index(Segment::head)].mass_kg = 1e4; }));
  faults.push_back(
      changed("AFootWithoutMass", [](Request& r) { r.body.segments[index(Segment::foot_l)].mass_kg = 0.0; }));
  faults.push_back(changed("AFootWithoutInertia", [](Request& r) {
    r.body.segments[index(Segment::foot_l)].inertia = Mat3::Zero();
  }));
  faults.push_back(changed("AFootWithNegativeInertia",
                           [](Request& r) { r.body.segments[index(Segment::foot_l)].inertia *= -1.0; }));
  faults.push_back(changed("ShapesWithoutSize", [](Request& r) {
    for (BodySegment& segment : r.body.segments)
      for (Shape& shape : segment.shapes) {
        shape.radius = shape.length = 0.0;
        shape.size = Vec3::Zero();
      }
  }));
  faults.push_back(changed("NoShapes", [](Request& r) {
    for (BodySegment& segment : r.body.segments) segment.shapes.clear();
  }));
  return faults;
}

std::vector<Fault> blows() {
  std::vector<Fault> faults;
  const auto ball = [&](const char* name, double mass, double speed, double radius) {
    faults.push_back(changed(name, [=](Request& r) {
      r.scene.ball_mass_kg = mass;
      r.scene.ball_speed_m_s = speed;
      r.scene.ball_radius_m = radius;
    }));
  };
  ball("ABallAtAThousandMetresPerSecond", 5.0, 1000.0, 0.12);
  ball("ABulletAtAThousandMetresPerSecond", 0.001, 1000.0, 0.005);
  ball("TenTonsAtAThousandMetresPerSecond", 1e4, 1000.0, 0.12);
  ball("TenTonsAtAWalk", 1e4, 1.5, 0.5);
  ball("ABallOfFiveMetresRadius", 5.0, 6.0, 5.0);
  ball("ABallOfAnInfiniteSpeed", 5.0, kInfinity, 0.12);
  ball("ABallOfNoMass", 0.0, 6.0, 0.12);
  ball("ABallOfNoRadius", 5.0, 6.0, 0.0);
  ball("ABallThatIsNotANumber", kNan, kNan, kNan);
  const auto scene = [&](const char* name, SceneKind kind, const std::function<void(Scene&)>& change) {
    faults.push_back(changed(name, [=](Request& r) {
      r.scene.kind = kind;
      change(r.scene);
    }));
  };
  scene("AnImpulseOfAMillionNewtonSeconds", SceneKind::impulse, [](Scene& s) { s.impulse_n_s = 1e6; });
  scene("APushOfTenMillionNewtons", SceneKind::push, [](Scene& s) { s.push_force_n = 1e7; });
  scene("AFallFromFiftyMetres", SceneKind::fall, [](Scene& s) { s.fall_height_m = 50.0; });
  scene("AFallFromHighAbove", SceneKind::fall, [](Scene& s) { s.fall_height_m = 1e6; });
  scene("TippedAtTwentyMetresPerSecond", SceneKind::fall, [](Scene& s) { s.tip_speed_m_s = 20.0; });
  scene("ABallDownASteepSlope", SceneKind::slope, [](Scene& s) {
    s.slope_rad = radians(60.0);
    s.ball_speed_m_s = 1000.0;
  });
  scene("ABallDownAFlatSlope", SceneKind::slope, [](Scene& s) { s.slope_rad = 0.0; });
  scene("ABoxOfTenMetres", SceneKind::box, [](Scene& s) { s.ball_radius_m = 5.0; });
  scene("ABoxFromAbove", SceneKind::box, [](Scene& s) { s.direction = Vec3(0.0, -1.0, 0.0); });
  scene("ASlopeFromAbove", SceneKind::slope, [](Scene& s) { s.direction = Vec3(0.0, -1.0, 0.0); });
  scene("AFallFromAbove", SceneKind::fall, [](Scene& s) { s.direction = Vec3(0.0, -1.0, 0.0); });
  scene("ABlowWithoutDirection", SceneKind::ball, [](Scene& s) { s.direction = Vec3::Zero(); });
  scene("ABlowOfNoNumber", SceneKind::impulse, [](Scene& s) { s.direction = Vec3::Constant(kNan); });
  return faults;
}

std::vector<Fault> starts() {
  std::vector<Fault> faults = {
      {"EveryJointTurnedByASixthOfATurn", [] { return twisted_man(kPi / 3.0); }},
      {"EveryJointTurnedByHalfATurn", [] { return twisted_man(kPi); }},
      {"FarOutsideARangeThatIsNotWidened",
       [] {
         Request request = twisted_man(2.5);
         request.range = *load_range_of_motion("human");
         return request;
       }},
      {"UpsideDownInTheFloor",
       [] {
         BodyPose segments = StandingMan().segments;
         for (Rigid& segment : segments)
           segment = Rigid{exp_rotation(Vec3(kPi, 0, 0)), Vec3::Zero()} * segment;
         return request_of(segments, 1.75, 0.0);
       }},
  };
  faults.push_back(
      changed("FasterThanAnything", [](Request& r) { r.start.linear_velocity.fill(Vec3(1e6, 0.0, 0.0)); }));
  faults.push_back(changed("NinetyMetresPerSecond",
                           [](Request& r) { r.start.linear_velocity.fill(Vec3(90.0, 0.0, 0.0)); }));
  faults.push_back(changed("AHandThatSpins", [](Request& r) {
    r.start.angular_velocity[index(Segment::hand_l)] = Vec3(1e4, 0.0, 0.0);
  }));
  faults.push_back(changed("AHandThatFliesOff", [](Request& r) {
    r.start.linear_velocity[index(Segment::hand_l)] = Vec3(0.0, 99.0, 0.0);
  }));
  faults.push_back(changed("APelvisAtNoPlace", [](Request& r) {
    r.start.segments[index(Segment::pelvis)].translation.x() = kNan;
  }));
  faults.push_back(changed("AHeadOfNoRotation", [](Request& r) {
    r.start.segments[index(Segment::head)].rotation.coeffs().setZero();
  }));
  faults.push_back(changed("AHeadOfNoNumber", [](Request& r) {
    r.start.segments[index(Segment::head)].rotation.coeffs().setConstant(kNan);
  }));
  faults.push_back(changed("AHandAMetreFromItsWrist", [](Request& r) {
    r.start.segments[index(Segment::hand_l)].translation.y() += 1.0;
  }));
  faults.push_back(changed("AnAnchorFarAway", [](Request& r) {
    r.body.joints[index(Joint::wrist_l)].anchor_in_parent = Vec3(0.0, 1e3, 0.0);
  }));
  faults.push_back(changed("ARangeOfNoNumbers", [](Request& r) {
    r.range.joints[index(Joint::knee_l)].polygon.front().setConstant(kNan);
  }));
  faults.push_back(changed("ARangeWithoutCorners",
                           [](Request& r) { r.range.joints[index(Joint::knee_l)].polygon.clear(); }));
  return faults;
}

std::vector<Fault> settings() {
  std::vector<Fault> faults;
  const auto with = [&](const char* name, const std::function<void(SimulationSettings&)>& change) {
    faults.push_back(changed(name, [=](Request& r) { change(r.settings); }));
  };
  with("NoGravity", [](auto& s) { s.gravity = 0.0; });
  with("GravityUpwards", [](auto& s) { s.gravity = -9.81; });
  with("AThousandGravities", [](auto& s) { s.gravity = 9810.0; });
  with("GravityOfNoNumber", [](auto& s) { s.gravity = kNan; });
  with("OneFramePerSecond", [](auto& s) { s.fps = 1.0; });
  with("AThousandFramesPerSecond", [](auto& s) { s.fps = 1000.0; });
  with("AMinuteAtAThousandFramesPerSecond", [](auto& s) {
    s.fps = 1000.0;
    s.duration_s = 60.0;
  });
  with("AMicrosecond", [](auto& s) { s.duration_s = 1e-6; });
  with("AnInfiniteDuration", [](auto& s) { s.duration_s = kInfinity; });
  with("AnInfiniteFrameRate", [](auto& s) { s.fps = kInfinity; });
  with("ABillionFrames", [](auto& s) {
    s.fps = 1e9;
    s.duration_s = 60.0;
  });
  with("FullTone", [](auto& s) { s.tone = 1.0; });
  with("ToneThatFadesAtOnce", [](auto& s) { s.tone_fade_s = 0.0; });
  with("ActiveTwoThousand", [](auto& s) { s.active_k = 2000.0; });
  with("ActiveBelowZero", [](auto& s) { s.active_k = -5.0; });
  with("ActiveOfNoNumber", [](auto& s) { s.active_k = kNan; });
  with("DampingAHundred", [](auto& s) { s.damping = 100.0; });
  with("DampingBelowZero", [](auto& s) { s.damping = -10.0; });
  with("SixtyHertzWithEverything", [](auto& s) {
    s.fixed_hz = 60.0;
    s.active_k = 2000.0;
    s.damping = 100.0;
    s.tone = 1.0;
  });
  with("ExplicitAtItsEdge", [](auto& s) {
    s.active = Active::explicit_torque;
    s.fixed_hz = 480.0;
    s.active_k = 47.9;
  });
  with("AxesAtSixtyHertz", [](auto& s) {
    s.limits = Limits::axis;
    s.fixed_hz = 60.0;
  });
  with("EulerStopsAtSixtyHertz", [](auto& s) {
    s.limits = Limits::segments_euler;
    s.fixed_hz = 60.0;
  });
  with("ChordsAdaptive", [](auto& s) { s.limits = Limits::segments; });
  with("NoLimitsAtAll", [](auto& s) { s.limits = Limits::none; });
  with("ARateOfNoNumber", [](auto& s) { s.fixed_hz = kNan; });
  with("AnInfiniteRate", [](auto& s) { s.fixed_hz = kInfinity; });
  return faults;
}

std::vector<Fault> all_faults() {
  std::vector<Fault> all;
  for (auto table : {sizes_and_masses(), blows(), starts(), settings()})
    for (Fault& fault : table) all.push_back(std::move(fault));
  return all;
}

Result<SimulationResult> run(const Request& r, Diagnostics& diagnostics) {
  return test::simulate_limp(r.body, r.range, r.start, r.scene, r.settings, diagnostics);
}

/// Of a bake that nothing is wrong with.
std::string hash_of_a_sane_bake() {
  Request request = man();
  request.settings.duration_s = 0.25;
  Diagnostics diagnostics;
  const auto result = run(request, diagnostics);
  return result ? result->figures.hash : result.error().what;
}

void expect_finite(const Request& request, const SimulationResult& result) {
  const auto& settings = request.settings;
  const auto frames = static_cast<std::size_t>(std::floor(duration_of(settings) * settings.fps + 1e-6)) + 1;
  EXPECT_EQ(result.trajectory.frames.size(), frames);
  for (const BodyPose& frame : result.trajectory.frames)
    for (const Rigid& segment : frame) {
      ASSERT_TRUE(segment.translation.allFinite() && segment.rotation.coeffs().allFinite());
      ASSERT_LT(segment.translation.norm(), 1e7);
    }
  for (const Prop& prop : result.trajectory.props)
    for (const Rigid& pose : prop.poses) ASSERT_TRUE(pose.translation.allFinite());
  EXPECT_LT(result.figures.joint_separation_max_m, 0.2 * std::max(1.0, request.body.height_m / 1.75));
  EXPECT_TRUE(std::isfinite(result.figures.energy_gain_max_j));
}

void expect_clear(const Error& error) {
  EXPECT_NE(error.kind, ErrorKind::internal) << error.message();
  EXPECT_FALSE(error.what.empty());
  EXPECT_FALSE(error.fix.empty());
}

/// What is refused or cannot be simulated, and words of the error; everything else gives a clip.
const std::map<std::string, std::string> kRefusals = {
    {"OneGramAndTenCentimetres", "the simulation diverged at"},
    {"TenCentimetres", "the simulation diverged at"},
    {"OneGram", "the simulation diverged at"},
    {"AFootWithoutMass", "joint 'foot_l': has no mass"},
    {"AFootWithoutInertia", "joint 'foot_l': has no moment of inertia"},
    {"AFootWithNegativeInertia", "joint 'foot_l': has no moment of inertia"},
    {"ShapesWithoutSize", "joint 'pelvis': has a shape without size"},
    {"ABallAtAThousandMetresPerSecond", "joint 'chest': the simulation diverged at 0.000 s"},
    {"TenTonsAtAThousandMetresPerSecond", "joint 'abdomen': the simulation diverged at 0.000 s"},
    {"ABallOfAnInfiniteSpeed", "the ball's mass, radius and speed must be above 0"},
    {"ABallOfNoMass", "the ball's mass, radius and speed must be above 0"},
    {"ABallOfNoRadius", "the ball's mass, radius and speed must be above 0"},
    {"ABallThatIsNotANumber", "the ball's mass, radius and speed must be above 0"},
    {"AnImpulseOfAMillionNewtonSeconds", "joint 'chest': the simulation diverged at 0.000 s"},
    {"APushOfTenMillionNewtons", "joint 'abdomen': the simulation diverged at 0.000 s"},
    {"ABallDownASteepSlope", "joint 'foot_l': the simulation diverged at"},
    {"ABallDownAFlatSlope", "the slope must lie between 0 and 90 degrees"},
    {"ASlopeFromAbove", "a ramp cannot come from straight above"},
    {"ABlowWithoutDirection", "the blow has no direction"},
    {"ABlowOfNoNumber", "the blow has no direction"},
    {"FarOutsideARangeThatIsNotWidened", "joint 'shank_l': the simulation diverged at 0.000 s"},
    {"FasterThanAnything", "joint 'pelvis': the simulation diverged at 0.000 s"},
    {"AHandThatSpins", "joint 'hand_l': the simulation diverged at 0.000 s"},
    {"APelvisAtNoPlace", "joint 'pelvis': starts at no place"},
    {"AHeadOfNoRotation", "joint 'head': starts at no place"},
    {"AHeadOfNoNumber", "joint 'head': starts at no place"},
    {"AHandAMetreFromItsWrist", "joint 'hand_l': the simulation diverged at 0.000 s"},
    {"AnAnchorFarAway", "joint 'hand_l': the simulation diverged at 0.000 s"},
    {"ARangeOfNoNumbers", "joint 'knee_l': has no range of motion"},
    {"ARangeWithoutCorners", "joint 'knee_l': has no range of motion"},
    {"AThousandGravities", "joint 'pelvis': the simulation diverged at"},
    {"GravityOfNoNumber", "gravity is not a number"},
    {"AnInfiniteDuration", "inf s at 60 frames per second are more than 100000 frames"},
    {"AnInfiniteFrameRate", "1 s at inf frames per second are more than 100000 frames"},
    {"ABillionFrames", "60 s at 1e+09 frames per second are more than 100000 frames"},
    {"ActiveBelowZero", "the active restriction's k must be above 0"},
    {"ActiveOfNoNumber", "the active restriction's k must be above 0"},
    {"DampingBelowZero", "the damping must not be negative"},
    {"ARateOfNoNumber", "the rate must be above 0 and at most 100000 Hz"},
    {"AnInfiniteRate", "the rate must be above 0 and at most 100000 Hz"},
};

class SimulationFault : public testing::TestWithParam<Fault> {};

TEST_P(SimulationFault, GivesAFiniteClipOrTheRefusalThatIsExpectedAndLeavesNothingBehind) {
  static const std::string sane = hash_of_a_sane_bake();
  const Request request = GetParam().request();
  Diagnostics diagnostics;
  const auto result = run(request, diagnostics);
  if (const auto refusal = kRefusals.find(GetParam().name); refusal == kRefusals.end()) {
    ASSERT_TRUE(result) << result.error().message();
    expect_finite(request, *result);
  } else {
    ASSERT_FALSE(result);
    expect_clear(result.error());
    EXPECT_NE(result.error().message().find(refusal->second), std::string::npos) << result.error().message();
  }
  EXPECT_EQ(hash_of_a_sane_bake(), sane);
}

INSTANTIATE_TEST_SUITE_P(All, SimulationFault, testing::ValuesIn(all_faults()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(SimulationFaults, EveryRefusalIsThatOfAFault) {
  std::set<std::string> names;
  for (const Fault& fault : all_faults()) names.insert(fault.name);
  for (const auto& [name, error] : kRefusals) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(SimulationFaults, ARunThatDivergesIsRunAgainAndThenAnErrorWithSegmentTimeAndSpeed) {
  Request request = man();
  request.scene.kind = SceneKind::impulse;
  request.scene.impulse_n_s = 1e6;
  Diagnostics diagnostics;
  const auto result = run(request, diagnostics);
  ASSERT_FALSE(result);
  EXPECT_EQ(exit_status(result.error().kind), 3);
  EXPECT_EQ(result.error().joint, "chest");
  EXPECT_TRUE(result.error().what.starts_with("the simulation diverged at 0.000 s: 1.09e+05 m/s"))
      << result.error().what;
  ASSERT_EQ(diagnostics.warnings().size(), 1u);
  EXPECT_EQ(diagnostics.warnings()[0].subject, "chest");
  EXPECT_NE(diagnostics.warnings()[0].what.find("it is run again at twice the rate"), std::string::npos);
}

TEST(SimulationFaults, AHandThatIsOffItsJointIsNoMotion) {
  Request request = man();
  request.start.segments[index(Segment::hand_l)].translation.y() += 1.0;
  Diagnostics diagnostics;
  const auto result = run(request, diagnostics);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().joint, "hand_l");
  EXPECT_NE(result.error().what.find("m off its joint"), std::string::npos) << result.error().what;
}

TEST(SimulationFaults, ABodyThatSinksIntoTheFloorIsSaid) {
  Diagnostics diagnostics;
  ASSERT_TRUE(run(man(30.0), diagnostics));
  ASSERT_FALSE(diagnostics.warnings().empty());
  EXPECT_TRUE(diagnostics.warnings().back().what.starts_with("the body sinks"));
}

}  // namespace
}  // namespace ukemi
