// What happens in a motion, from the joints' places alone: blow, steps, contacts, rest, getting up.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "judge/body_course.h"

namespace ukemi {

enum class ReactionKind { stand, fall, get_up };
std::string_view name(ReactionKind kind);  // "stand", "fall", "getup"

enum class JudgedOutcome { stood, stepped, fell };
std::string_view name(JudgedOutcome outcome);

enum class JudgedPose { standing, kneeling, seated, supine, prone, left_side, right_side };
std::string_view name(JudgedPose pose);  // "standing", ... "left_side"

/// Frames [begin, end) that are judged.
struct Window {
  int begin = 0;
  int end = 0;
};

/// A foot that goes to another place.
struct Step {
  int side = 0;  // 0 left, 1 right
  int lift = 0, contact = 0;
  double lift_s = 0.0, contact_s = 0.0;
  double length_m = 0.0;
  double height_m = 0.0;  // of the ankle over its lower end
};

/// A foot that goes faster over the ground is in no place.
inline constexpr double kPlantedSpeed_m_s = 0.3;

/// Steps that begin in the window. A foot steps while the point midway between ankle and ball is faster than
/// 0.18 m/s over the ground, if it reaches 0.35 m/s, goes 6 cm and takes 0.06 s.
std::vector<Step> steps_in(const BodyCourse& body, const Window& window);

/// A part of the body on the floor for the first time; speed: downwards, at most, shortly before.
struct Contact {
  int frame = 0;
  double time_s = 0.0;
  double speed_m_s = 0.0;
};

/// Contact heights: pelvis 0.20 m, wrist or knuckle 0.10, knee 0.10, skull base 0.17.
struct FallEvents {
  int descent = 0;           // frame from which on the centre of mass sinks faster than 0.3 m/s
  double fall_begins_s = 0;  // its time
  Contact pelvis;            // where it stays in the air: when knee or head come down
  bool pelvis_down = false;
  std::optional<Contact> head, hand, knee;
  double elbow_deg = 0.0;        // at the hand's contact; 180: straight
  double front_up = 0.0;         // at the pelvis's contact: 1 on the back, -1 on the belly
  std::optional<double> rest_s;  // from then on nothing is faster than 0.25 m/s for 0.25 s
  int rest = 0;                  // its frame; the window's end where there is no rest
};

FallEvents fall_events(const BodyCourse& body, const Window& window);

struct GetUpEvents {
  int begin = 0;                     // head or pelvis have gone 8 cm
  int leaves_floor = 0;              // the pelvis was below 0.25 m for the last time
  std::optional<int> upright;        // from then on
  double begins_s = 0.0;             // time of `begin`
  std::optional<double> stands_s{};  // time of `upright`
};

/// Events of a body that lies still in the window's first frame.
GetUpEvents get_up_events(const BodyCourse& body, const Window& window);

/// The way up, from the frame of rest on, of a body that fell and stands again at the end.
std::optional<GetUpEvents> get_up_after(const BodyCourse& body, const Window& window, const FallEvents& fall);

/// A person who lies at the window's begin gets up; one whose pelvis or head comes down falls.
ReactionKind kind_of(const BodyCourse& body, const Window& window);

/// The blow's frame in the window: the head, seen from its first velocity, gathers speed; the last frame
/// before it reaches half of its top speed for the first time in which it had less than a tenth.
int find_blow(const BodyCourse& body, const Window& window);

JudgedPose final_pose(const BodyCourse& body, int frame);
/// On knees and face, the pelvis in the air: no person stays so.
bool folded_on_face(const BodyCourse& body, int frame);

/// Time of a frame, seconds.
inline double time_of(const BodyCourse& body, int frame) { return frame / body.fps; }
/// The frames in this time, rounded down.
inline int frames_of(const BodyCourse& body, double seconds) {
  return static_cast<int>(seconds * body.fps + 1e-6);
}

}  // namespace ukemi
