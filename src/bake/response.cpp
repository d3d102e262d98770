#include "bake/response.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "body/on_ground.h"
#include "feet/legs.h"
#include "judge/events.h"
#include "judge/signal.h"

namespace ukemi {
namespace {

constexpr double kStandingShare = 0.75;  // of the pelvis's height at the start
constexpr double kOffFloor_m = 0.004;    // a sole whose lowest corner is higher is off the floor
constexpr double kFlat_m = 0.010;        // between the highest and the lowest corner of a level sole
constexpr double kSettling_s = 0.05;     // of a plant

std::optional<TouchDown> earlier(const std::optional<TouchDown>& a, const std::optional<TouchDown>& b) {
  if (!a || !b) return a ? a : b;
  return a->time_s <= b->time_s ? a : b;
}

using Corners = std::array<Vec3, 4>;

Corners corners_at(const Leg& leg, const BodyPose& pose) {
  Corners corners;
  for (int i = 0; i < 4; ++i) corners[i] = pose[index(leg.foot)] * leg.sole[i];
  return corners;
}

/// How far the least moved corner of a sole has gone over the ground.
double least_way(const Corners& from, const Corners& to) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 4; ++i) least = std::min(least, horizontal_norm(to[i] - from[i]));
  return least;
}

bool in_the_air(const std::vector<StepTaken>& steps, Segment foot, double time_s) {
  return std::any_of(steps.begin(), steps.end(), [&](const StepTaken& step) {
    return step.foot == foot && time_s >= step.lift_s && (!step.contact_s || time_s < *step.contact_s);
  });
}

/// The contract of foot_slide, for a sole that is not in the air of a step.
bool stands(const Corners& before, const Corners& now, double frame_s) {
  const auto [low, high] =
      std::minmax_element(now.begin(), now.end(), [](const Vec3& a, const Vec3& b) { return a.y() < b.y(); });
  if (low->y() > kOffFloor_m) return false;
  return high->y() - low->y() < kFlat_m || least_way(before, now) < kPlantedSpeed_m_s * frame_s;
}

/// Ways of a sole's corners while it stands.
class Plant {
 public:
  /// How far the least moved corner has gone.
  double stand(const Corners& corners, double time_s) {
    if (!since_s_) since_s_ = time_s;
    if (time_s - *since_s_ < kSettling_s) {
      from_ = corners;
      most_.fill(0.0);
      return 0.0;
    }
    for (int i = 0; i < 4; ++i) most_[i] = std::max(most_[i], horizontal_norm(corners[i] - from_[i]));
    return *std::min_element(most_.begin(), most_.end());
  }
  void lift() { since_s_.reset(); }

 private:
  std::optional<double> since_s_;
  Corners from_{};
  std::array<double, 4> most_{};
};

double slide_of(const Leg& leg, const Trajectory& trajectory, const std::vector<StepTaken>& steps,
                double until_s) {
  Plant plant;
  double most = 0.0;
  Corners before = corners_at(leg, trajectory.frames.front());
  for (std::size_t f = 0; f < trajectory.frames.size(); ++f) {
    const double time_s = static_cast<double>(f) / trajectory.fps;
    if (time_s > until_s) break;
    const Corners now = corners_at(leg, trajectory.frames[f]);
    if (in_the_air(steps, leg.foot, time_s) || !stands(before, now, 1.0 / trajectory.fps))
      plant.lift();
    else
      most = std::max(most, plant.stand(now, time_s));
    before = now;
  }
  return most;
}

}  // namespace

std::string_view name(Behaviour behaviour) {
  constexpr std::string_view kNames[] = {"alert", "dazed", "limp"};
  return kNames[static_cast<int>(behaviour)];
}

std::string_view name(Outcome outcome) {
  constexpr std::string_view kNames[] = {"stood", "stepped", "fell"};
  return kNames[static_cast<int>(outcome)];
}

EndPose final_pose_of(const BodyPose& start, const BodyPose& end) {
  const Rigid& pelvis = end[index(Segment::pelvis)];
  const Quat& chest = end[index(Segment::chest)].rotation;
  const double height = pelvis.translation.y() / start[index(Segment::pelvis)].translation.y();
  const double upright = (chest * Vec3::UnitY()).y();
  if (height > kStandingShare && upright > 0.3) return EndPose::standing;
  const double knee =
      std::min(end[index(Segment::shank_l)].translation.y(), end[index(Segment::shank_r)].translation.y()) /
      start[index(Segment::pelvis)].translation.y();
  if (upright > 0.6 && height > 0.35 && knee < 0.2) return EndPose::kneeling;
  if (upright > 0.5) return EndPose::seated;
  const double front = (chest * Vec3::UnitX()).y();
  if (std::abs(front) > 0.6) return front > 0.0 ? EndPose::supine : EndPose::prone;
  return (chest * Vec3::UnitZ()).y() < 0.0 ? EndPose::right_side : EndPose::left_side;
}

double foot_slide(const ArticulatedBody& body, const BodyPose& home, const Trajectory& trajectory,
                  const std::vector<StepTaken>& steps, double until_s) {
  double most = 0.0;
  for (const BodySide side : kSides)
    most = std::max(most, slide_of(Leg(body, home, side), trajectory, steps, until_s));
  return most;
}

double get_up_slide(const BakedClip& outcome) {
  if (!outcome.get_up) return 0.0;
  const Trajectory& trajectory = outcome.timeline.trajectory;
  const auto begins = std::lround((outcome.timeline.impact_s + outcome.get_up->begins_s) * trajectory.fps);
  double most = 0.0;
  for (const PlantedPart& part : outcome.get_up->planted)
    for (long f = begins + part.first; f <= begins + part.last; ++f) {
      const BodyPose& frame = trajectory.frames.at(static_cast<std::size_t>(f));
      most = std::max(most, horizontal_norm(frame[index(part.segment)] * part.point - part.place));
    }
  return most;
}

std::string outcome_text(const Response& response) {
  const std::size_t steps = response.steps.size();
  std::string how(name(response.outcome));
  if (response.outcome == Outcome::stepped)
    how += steps == 1 ? std::string(" once") : fmt::format(" {} times", steps);
  std::string pose(name(response.end_pose));
  std::replace(pose.begin(), pose.end(), '_', ' ');
  return fmt::format("{}, ends {}", how, pose);
}

FirstContacts first_contacts(const SimulationFigures& figures, const ControllerReport& behaviour) {
  const auto touched = [&](Segment s) { return figures.touch_down[index(s)]; };
  FirstContacts contacts;
  for (int s = 0; s < kSegmentCount; ++s)
    if (s != index(Segment::foot_l) && s != index(Segment::foot_r))
      contacts.first = earlier(contacts.first, touched(segment_at(s)));
  contacts.hand = earlier(touched(Segment::hand_l), touched(Segment::hand_r));
  contacts.knee = behaviour.fall.knee;
  contacts.pelvis = touched(Segment::pelvis);
  contacts.head = touched(Segment::head);
  return contacts;
}

Response response_of(const BakedClip& outcome) {
  const SimulationFigures& figures = outcome.figures;
  const ControllerReport& report = outcome.behaviour;
  const Trajectory& trajectory = outcome.timeline.trajectory;
  const auto first = static_cast<std::size_t>(std::lround(outcome.timeline.impact_s * trajectory.fps));
  Response response;
  response.behaviour = outcome.prepared.behaviour.kind;
  response.steps = report.steps;
  for (StepTaken& step : response.steps) {
    step.lift_s += outcome.timeline.impact_s;
    if (step.contact_s) *step.contact_s += outcome.timeline.impact_s;
  }
  if (report.fall_begins_s) response.fall_begins_s = outcome.timeline.impact_s + *report.fall_begins_s;
  if (report.knocked_out_s) response.knocked_out_s = outcome.timeline.impact_s + *report.knocked_out_s;
  response.contacts = first_contacts(figures, report);
  FirstContacts& c = response.contacts;
  for (std::optional<TouchDown>* touch : {&c.first, &c.hand, &c.knee, &c.pelvis, &c.head})
    if (*touch) (*touch)->time_s += outcome.timeline.impact_s;
  const BodyPose& start = trajectory.frames[std::min(first, trajectory.frames.size() - 1)];
  const BodyPose& end = trajectory.frames.back();
  response.end_pose = final_pose_of(outcome.prepared.start.state.segments, end);
  response.outcome = response.end_pose != EndPose::standing || response.fall_begins_s ? Outcome::fell
                     : response.steps.empty()                                         ? Outcome::stood
                                                                                      : Outcome::stepped;
  response.foot_slide_max_m =
      foot_slide(outcome.prepared.body, outcome.prepared.home, trajectory, response.steps,
                 response.fall_begins_s.value_or(std::numeric_limits<double>::infinity()));
  response.travel_m = end[0].translation - start[0].translation;
  response.turn_deg =
      degrees(wrapped(yaw_of(end[0].rotation * Vec3::UnitX()) - yaw_of(start[0].rotation * Vec3::UnitX())));
  return response;
}

}  // namespace ukemi
