// How a body responded to its blow, read from the simulation.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/baked.h"
#include "behave/lying.h"

namespace ukemi {

enum class Outcome { stood, stepped, fell };
std::string_view name(Behaviour behaviour);
std::string_view name(Outcome outcome);

/// Times of the first contacts with the floor, seconds after the blow. Knee: only of a living body that fell.
struct FirstContacts {
  std::optional<TouchDown> first;  // of all but the feet
  std::optional<TouchDown> hand, knee, pelvis, head;
};
FirstContacts first_contacts(const SimulationFigures& figures, const ControllerReport& behaviour);

/// Times are the clip's, from its beginning.
struct Response {
  Behaviour behaviour = Behaviour::alert;
  Outcome outcome = Outcome::stood;
  EndPose end_pose = EndPose::standing;
  std::vector<StepTaken> steps;
  std::optional<double> fall_begins_s;
  std::optional<double> knocked_out_s;
  FirstContacts contacts;
  double foot_slide_max_m = 0.0;  // of a sole's least moved corner while it stands, until the body falls
  Vec3 travel_m = Vec3::Zero();   // of the pelvis
  double turn_deg = 0.0;          // of the pelvis, to the left
};

/// What the last frame of a motion that began upright shows.
EndPose final_pose_of(const BodyPose& start, const BodyPose& end);

/// How far a standing sole slides at most, m: the way of its least moved corner from 50 ms after it touched,
/// up to `until_s`. A foot stands with a corner within 4 mm of the floor for more than 50 ms, but not
/// 1. between lift and contact of one of `steps` (times of the trajectory);
/// 2. where it touches with an edge that goes faster than kPlantedSpeed_m_s (judge/events.h): a swing passes
///    close to the floor. A flat sole that is dragged stands at any speed.
/// `home`: a pose in which the soles are level.
double foot_slide(const ArticulatedBody& body, const BodyPose& home, const Trajectory& trajectory,
                  const std::vector<StepTaken>& steps, double until_s);

/// How far a part that bears in the get-up moves over the floor at the most, m. 0 without a get-up.
double get_up_slide(const BakedClip& outcome);

/// "stepped 3 times, ends standing".
std::string outcome_text(const Response& response);

Response response_of(const BakedClip& outcome);

}  // namespace ukemi
