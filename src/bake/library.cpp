#include "bake/library.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "bake/response.h"
#include "base/csv.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNever = -1.0;

double or_never(const std::optional<double>& value) { return value.value_or(kNever); }

/// The nearest of eight words; above and below where it comes from steeper than 60 degrees.
std::string direction_word(const Direction& from) {
  constexpr double kSteep = 60.0;
  constexpr const char* kWords[] = {"front", "front_left", "left",  "back_left",
                                    "back",  "back_right", "right", "front_right"};
  if (degrees(from.elevation) > kSteep) return "above";
  if (degrees(from.elevation) < -kSteep) return "below";
  const auto eighth = static_cast<long>(std::lround(from.azimuth / (kPi / 4)));
  return kWords[(eighth % 8 + 8) % 8];
}

/// Degrees in [0, 360), from the front over the left.
double direction_deg(const Direction& from) {
  const double deg = std::fmod(degrees(from.azimuth), 360.0);
  return deg < 0.0 ? deg + 360.0 : deg;
}

/// Largest speed of the head's centre of mass from the blow on, m/s.
double head_speed(const BakedClip& outcome) {
  const Trajectory& trajectory = outcome.timeline.trajectory;
  const int head = index(Segment::head);
  const Vec3& centre = outcome.prepared.body.segments[head].centre_of_mass;
  const auto first = static_cast<std::size_t>(std::lround(outcome.timeline.impact_s * trajectory.fps));
  double most = 0.0;
  for (std::size_t f = first + 1; f < trajectory.frames.size(); ++f)
    most = std::max(most,
                    (trajectory.frames[f][head] * centre - trajectory.frames[f - 1][head] * centre).norm());
  return most * trajectory.fps;
}

/// Whether the last frame is the first: within 5 mm and a degree.
bool is_loopable(const Trajectory& trajectory) {
  constexpr double kNear_m = 0.005;
  constexpr double kNear_deg = 1.0;
  for (int s = 0; s < kSegmentCount; ++s) {
    const Rigid& first = trajectory.frames.front()[s];
    const Rigid& last = trajectory.frames.back()[s];
    if ((first.translation - last.translation).norm() > kNear_m) return false;
    if (degrees(angle_between(first.rotation, last.rotation)) > kNear_deg) return false;
  }
  return true;
}

/// When a segment first touches the floor, clip time.
double contact_s(const BakedClip& outcome, Segment s) {
  const auto& touch = outcome.figures.touch_down[index(s)];
  return touch ? touch->time_s + outcome.timeline.impact_s : kNever;
}

double earlier(double a, double b) { return a < 0.0 ? b : b < 0.0 ? a : std::min(a, b); }

double mark_s(const Clip& clip, std::string_view name) {
  for (const Mark& mark : clip.marks)
    if (mark.name == name) return mark.time_s;
  return kNever;
}

void add_blow(const BakeSettings& settings, const BakedClip& outcome, Json& row) {
  row["Segment"] = name(outcome.prepared.scene.target);
  row["FromDeg"] = direction_deg(settings.from);
  row["FromElevationDeg"] = degrees(settings.from.elevation);
  row["From"] = direction_word(settings.from);
  row["Preset"] = settings.preset;
  row["MomentumNs"] = outcome.figures.momentum_n_s;
}

void add_response(const BakedClip& outcome, Json& row) {
  const Response response = response_of(outcome);
  row["Behaviour"] = name(response.behaviour);
  row["Outcome"] = name(response.outcome);
  row["EndPose"] = name(response.end_pose);
  row["TurnDeg"] = response.turn_deg;
  row["TravelX"] = response.travel_m.x();
  row["TravelY"] = response.travel_m.y();
  row["TravelZ"] = response.travel_m.z();
  row["Steps"] = response.steps.size();
  row["FirstStepS"] = response.steps.empty() ? kNever : response.steps.front().lift_s;
  row["LastStepS"] = response.steps.empty() ? kNever : or_never(response.steps.back().contact_s);
  row["FallBeginsS"] = or_never(response.fall_begins_s);
}

void add_contacts(const BakedClip& outcome, Json& row) {
  const auto touched = [&](Segment left, Segment right) {
    return earlier(contact_s(outcome, left), contact_s(outcome, right));
  };
  row["HeadContactS"] = contact_s(outcome, Segment::head);
  row["ChestContactS"] = contact_s(outcome, Segment::chest);
  row["PelvisContactS"] = contact_s(outcome, Segment::pelvis);
  row["HandContactS"] = touched(Segment::hand_l, Segment::hand_r);
  row["ForearmContactS"] = touched(Segment::forearm_l, Segment::forearm_r);
  row["KneeContactS"] = touched(Segment::shank_l, Segment::shank_r);
}

void add_times(const BakedClip& outcome, Json& row) {
  const Clip& clip = outcome.timeline.clip;
  row["DurationS"] = clip.duration_s();
  row["ImpactS"] = outcome.timeline.impact_s;
  row["FirstGroundContactS"] = mark_s(clip, "first_ground_contact");
  row["RestS"] = mark_s(clip, "rest");
  row["GetUpS"] = mark_s(clip, "get_up");
  row["RecoveredS"] = mark_s(clip, "recover");
  row["Fps"] = clip.fps;
}

void add_use(const BakeSettings& settings, const BakedClip& outcome, Json& row) {
  const Start& start = outcome.prepared.start;
  row["StartPose"] = start.from_clip ? "clip" : start.name;
  row["StartClip"] = start.from_clip ? start.name : "";
  row["StartClipS"] = start.from_clip ? start.at_s : kNever;
  row["RootMotion"] = name(settings.ground.root_motion);
  row["Additive"] = settings.additive != Additive::off;
  row["Loopable"] = is_loopable(outcome.timeline.trajectory);
  row["PeakHeadSpeed"] = head_speed(outcome);
  row["Verdict"] = "";
}

/// ASCII letters in lower case.
std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// The rows as objects, each Name once; letter case does not count, as in the row names of Unreal.
std::vector<Json> rows_of(const std::vector<LibraryEntry>& entries) {
  std::vector<Json> rows;
  std::set<std::string> taken;
  for (const LibraryEntry& entry : entries) {
    Json row = Json::parse(entry.row);
    const std::string name = row["Name"];
    std::string unique = name;
    for (int i = 2; !taken.insert(lower(unique)).second; ++i) unique = name + '_' + std::to_string(i);
    row["Name"] = unique;
    row["Verdict"] = entry.verdict;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::string library_name(const std::string& character, const std::string& reaction) {
  const std::string prefix = character + '_';
  return reaction.starts_with(prefix) ? reaction : prefix + reaction;
}

std::string library_row(const std::string& character, const BakeSettings& settings, const BakedFile& baked) {
  const BakedClip& outcome = baked.outcome;
  Json row;
  row["Name"] = library_name(character, outcome.prepared.reaction);
  row["Character"] = character;
  row["Reaction"] = outcome.prepared.reaction;
  row["Clip"] = outcome.timeline.clip.name;
  row["File"] = settings.outputs.empty() ? "" : settings.outputs.front().generic_string();
  add_blow(settings, outcome, row);
  add_response(outcome, row);
  add_times(outcome, row);
  add_contacts(outcome, row);
  add_use(settings, outcome, row);
  return row.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_library_row(const std::string& text) {
  const Json row = Json::parse(text, nullptr, false);
  if (!row.is_object() || !row.contains("Name") || !row["Name"].is_string()) return false;
  return std::all_of(row.begin(), row.end(), [](const Json& value) {
    return value.is_string() || value.is_number() || value.is_boolean();
  });
}

std::string library_json(const std::vector<LibraryEntry>& entries) {
  return Json(rows_of(entries)).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string library_csv(const std::vector<LibraryEntry>& entries) {
  if (entries.empty()) return "Name\r\n";
  std::string text;
  for (const Json& row : rows_of(entries)) {
    std::string titles, line;
    for (const auto& [key, value] : row.items()) {
      titles += (titles.empty() ? "" : ",") + csv_text(key);
      line += (key == "Name" ? "" : ",") + (value.is_string() ? csv_text(value) : value.dump());
    }
    text += (text.empty() ? titles + "\r\n" : "") + line + "\r\n";
  }
  return text;
}

}  // namespace ukemi
