#include "check/judge_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/animation.h"
#include "base/character_path.h"
#include "base/errors.h"
#include "base/native_rate.h"
#include "base/or_null.h"
#include "clip/frames.h"
#include "clip/names.h"
#include "judge/judge.h"
#include "load/load.h"

namespace ukemi {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastRate = 60.0, kMostRate = 120.0;  // frames per second

/// A file, and the clip that is meant; a '#' in the name of a file that exists is part of it.
struct FileAndClip {
  std::string file;
  std::optional<std::string> clip;
};

FileAndClip split(const std::string& text) {
  std::error_code error;
  const std::size_t hash = text.rfind('#');
  if (hash == std::string::npos || std::filesystem::exists(text, error)) return {text, std::nullopt};
  return {text.substr(0, hash), text.substr(hash + 1)};
}

Result<std::size_t> clip_of(const Character& character, const std::optional<std::string>& name) {
  if (character.animations.empty())
    return input_error(character.path, "holds no clip", "name a file with a clip");
  if (!name) return character.animations.size() - 1;
  const bool digits = !name->empty() && name->find_first_not_of("0123456789") == std::string::npos;
  const auto named = find_clip(character, *name);
  return !named && digits ? find_clip(character, "#" + *name) : named;
}

bool is_additive(const Animation& animation) {
  const Json json = Json::parse(animation.extras_json, nullptr, false);
  const Json::json_pointer place("/ukemi/additive");
  return json.is_object() && json.contains(place) && json[place] == true;
}

std::optional<double> baked_impact(const Animation& animation) {
  for (const Mark& mark : marks_in_extras(animation.extras_json))
    if (mark.name == "impact") return mark.time_s;
  return std::nullopt;
}

Status check_times(const JudgeSettings& settings, double duration_s) {
  const auto inside = [&](const std::optional<double>& time_s) { return !time_s || *time_s <= duration_s; };
  if (!inside(settings.impact_s) || !inside(settings.from_s))
    return usage_error(fmt::format("the clip ends at {:.3f} s, before what is to be judged", duration_s),
                       "give times within the clip");
  const double begin_s = settings.impact_s.value_or(settings.from_s.value_or(0.0));
  if (settings.to_s && *settings.to_s <= begin_s)
    return usage_error("--to is not after --impact and --from", "give a later time");
  return Done{};
}

JudgedClip judged(const Character& character, const Humanoid& humanoid, std::size_t clip,
                  const JudgeClipSettings& settings) {
  const Animation& animation = character.animations[clip];
  const double rate = std::clamp(native_rate(animation), kLeastRate, kMostRate);
  const Clip sampled = sample_clip(character.skeleton, animation, rate);
  JudgedMotion motion = judged_motion(character, humanoid, sampled);
  if (settings.mass_kg) motion.mass_kg = *settings.mass_kg;
  return {settings.file,  clip_label(character, clip),  sampled.fps, sampled.duration_s(), motion.height_m,
          motion.mass_kg, judge(motion, settings.judge)};
}

Json criterion_json(const Criterion& criterion) {
  Json values = Json::object(), bands = Json::object();
  for (const Clause& clause : criterion.clauses) {
    const std::string name(clause.name);
    values[name] = or_null<Json>(clause.value);
    const bool open = std::isinf(clause.band.high);
    bands[name] = {clause.band.low, open ? Json(nullptr) : Json(clause.band.high)};
  }
  return {{"number", criterion.number},
          {"name", criterion.name},
          {"values", std::move(values)},
          {"bands", std::move(bands)},
          {"passed", criterion.passed ? Json(*criterion.passed) : Json(nullptr)}};
}

Json contact_json(const std::optional<Contact>& contact) {
  if (!contact) return nullptr;
  return {{"time_s", contact->time_s}, {"speed_m_s", contact->speed_m_s}};
}

Json steps_json(const std::vector<Step>& steps) {
  Json json = Json::array();
  for (const Step& step : steps)
    json.push_back({{"foot", step.side == 0 ? "l" : "r"},
                    {"lift_s", step.lift_s},
                    {"contact_s", step.contact_s},
                    {"length_m", step.length_m},
                    {"ankle_rise_m", step.height_m}});
  return json;
}

Json events_json(const Judgement& judgement) {
  Json json = {{"impact_s", judgement.impact_s}, {"impact_found", judgement.impact_found}};
  const auto& fall = judgement.fall;
  json["fall_begins_s"] = fall ? Json(fall->fall_begins_s) : Json(nullptr);
  json["pelvis_contact"] = fall && fall->pelvis_down ? contact_json(fall->pelvis) : Json(nullptr);
  json["head_contact"] = fall ? contact_json(fall->head) : Json(nullptr);
  json["first_hand_contact"] = fall ? contact_json(fall->hand) : Json(nullptr);
  json["first_knee_contact"] = fall ? contact_json(fall->knee) : Json(nullptr);
  json["rest_s"] = fall ? or_null<Json>(fall->rest_s) : Json(nullptr);
  json["get_up"] = nullptr;
  if (const auto& get_up = judgement.get_up)
    json["get_up"] = {{"begins_s", get_up->begins_s}, {"stands_s", or_null<Json>(get_up->stands_s)}};
  return json;
}

std::string clause_text(const Clause& clause) {
  const std::string value = clause.value ? fmt::format("{:.3g}", *clause.value) : "none";
  const std::string band = std::isinf(clause.band.high)
                               ? fmt::format("at least {:g}", clause.band.low)
                               : fmt::format("{:g} to {:g}", clause.band.low, clause.band.high);
  return fmt::format("{} {}{} ({})", clause.name, value, clause.holds() ? "" : " OUT", band);
}

std::string criterion_text(const Criterion& criterion) {
  if (!criterion.passed) return fmt::format("{:>3} -    {}\n", criterion.number, criterion.name);
  std::string text =
      fmt::format("{:>3} {:<4} {}: ", criterion.number, *criterion.passed ? "ok" : "OUT", criterion.name);
  const bool all = criterion.clauses.size() <= 5;  // else those that fail
  std::string clauses;
  for (const Clause& clause : criterion.clauses)
    if (all || !clause.holds()) clauses += (clauses.empty() ? "" : ", ") + clause_text(clause);
  return text + (clauses.empty() ? "all within their limits" : clauses) + "\n";
}

std::string events_text(const Judgement& judgement) {
  std::string text =
      fmt::format("impact at {:.3f} s{}\n", judgement.impact_s, judgement.impact_found ? " (found)" : "");
  for (const Step& step : judgement.steps)
    text += fmt::format("  step {}: {:.3f} to {:.3f} s, {:.2f} m\n", step.side == 0 ? "left" : "right",
                        step.lift_s, step.contact_s, step.length_m);
  const auto contact = [&](std::string_view part, const std::optional<Contact>& c) {
    if (c) text += fmt::format("  {} on the floor: {:.3f} s at {:.2f} m/s\n", part, c->time_s, c->speed_m_s);
  };
  if (const auto& fall = judgement.fall) {
    text += fmt::format("  descent begins: {:.3f} s\n", fall->fall_begins_s);
    contact("knee", fall->knee);
    contact("hand", fall->hand);
    if (fall->pelvis_down) contact("pelvis", fall->pelvis);
    contact("head", fall->head);
    if (fall->rest_s) text += fmt::format("  at rest: {:.3f} s\n", *fall->rest_s);
  }
  if (const auto& get_up = judgement.get_up)
    text += fmt::format(
        "  gets up: {:.3f} s, {}\n", get_up->begins_s,
        get_up->stands_s ? fmt::format("stands at {:.3f} s", *get_up->stands_s) : "does not come to stand");
  return text;
}

}  // namespace

Result<JudgedClip> judge_clip(const JudgeClipSettings& settings, Diagnostics& diagnostics) {
  const FileAndClip what = split(settings.file);
  const auto path = character_path(what.file);
  if (!path) return path.error();
  const auto character = load_character(*path, LoadOptions{}, diagnostics);
  if (!character) return character.error();
  const auto clip = clip_of(*character, what.clip);
  if (!clip) return clip.error();
  const auto humanoid = map_humanoid(*character, settings.humanoid, diagnostics);
  if (!humanoid) return humanoid.error();
  const Animation& animation = character->animations[*clip];
  if (is_additive(animation))
    return input_error(character->path, "the clip is additive: a difference, no motion",
                       "judge the clip as it is without --additive");
  JudgeClipSettings told = settings;
  if (!told.judge.impact_s && !told.judge.from_s) told.judge.impact_s = baked_impact(animation);
  if (const Status times = check_times(told.judge, animation.duration_s()); !times) return times.error();
  return judged(*character, *humanoid, *clip, told);
}

std::string judgement_json(const JudgedClip& judged, const Diagnostics& diagnostics) {
  const Judgement& judgement = judged.judgement;
  Json json = {{"format", 1},
               {"file", judged.file},
               {"clip", judged.clip},
               {"duration_s", judged.duration_s},
               {"fps", judged.fps},
               {"height_m", judged.height_m},
               {"mass_kg", judged.mass_kg},
               {"mode", name(judgement.kind)},
               {"outcome", name(judgement.outcome)},
               {"end_pose", name(judgement.final_pose)},
               {"score", judgement.score}};
  json["criteria"] = Json::array();
  for (const Criterion& criterion : judgement.criteria) json["criteria"].push_back(criterion_json(criterion));
  json["events"] = events_json(judgement);
  json["steps"] = steps_json(judgement.steps);
  json["warnings"] = Json::array();
  for (const Warning& warning : diagnostics.warnings())
    json["warnings"].push_back(warning.subject.empty() ? warning.what
                                                       : warning.subject + ": " + warning.what);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string judgement_text(const JudgedClip& judged) {
  const Judgement& judgement = judged.judgement;
  int passed = 0, applicable = 0;
  std::string criteria;
  for (const Criterion& criterion : judgement.criteria) {
    criteria += criterion_text(criterion);
    passed += criterion.passed.value_or(false);
    applicable += criterion.passed.has_value();
  }
  return fmt::format("{}, clip '{}': {}, ends {}; {} of {} criteria, score {:.2f}\n", judged.file,
                     judged.clip, name(judgement.outcome), name(judgement.final_pose), passed, applicable,
                     judgement.score) +
         events_text(judgement) + criteria;
}

}  // namespace ukemi
