#include "prepare/setting_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/errors.h"
#include "base/nearest.h"
#include "base/parse_segment.h"
#include "base/segments.h"
#include "bones/map_file.h"
#include "prepare/impact.h"
#include "prepare/setting_words.h"
#include "prepare/settings.h"

namespace ukemi {
namespace {

std::vector<std::string> values_of(double value) { return {fmt::format("{}", value)}; }
std::vector<std::string> values_of(const std::string& value) {
  return value.empty() ? std::vector<std::string>() : std::vector<std::string>{value};
}
template <typename T>
std::vector<std::string> values_of(const std::optional<T>& value) {
  return value ? values_of(*value) : std::vector<std::string>();
}

/// A number held in `access(target)`, which is `scale` times what the user writes.
template <typename Target, typename Access>
SettingOf<Target> number(std::string_view name, std::string unit, const Range& range, std::string help,
                         Access access, double scale = 1.0) {
  SettingOf<Target> setting;
  setting.kind = SettingOf<Target>::Kind::number;
  setting.name = name;
  setting.value = std::move(unit);
  setting.help = std::move(help);
  setting.range = range;
  setting.set = [access, range, scale](Target& target, const std::string& text) -> Status {
    const auto value = parse_number(text, range);
    if (!value) return value.error();
    access(target) = scale * *value;
    return Done{};
  };
  setting.get = [access, scale](const Target& target) {
    const std::optional<double> held = access(target);
    return held ? values_of(*held / scale) : std::vector<std::string>();
  };
  return setting;
}

Status any_text(const std::string&) { return Done{}; }

/// Text held in `access(target)` once `check` agrees.
template <typename Target, typename Access>
SettingOf<Target> text(std::string_view name, std::string value, std::string help, Access access,
                       std::function<Status(const std::string&)> check = any_text) {
  SettingOf<Target> setting;
  setting.name = name;
  setting.value = std::move(value);
  setting.help = std::move(help);
  setting.set = [access, check = std::move(check)](Target& target, const std::string& given) -> Status {
    if (const Status status = check(given); !status) return status.error();
    access(target) = given;
    return Done{};
  };
  setting.get = [access](const Target& target) { return values_of(access(target)); };
  return setting;
}

/// One of `words`, which stand for the `values` of `access(target)`.
template <typename Target, typename Value, typename Access>
SettingOf<Target> choice(std::string_view name, std::vector<std::pair<std::string, Value>> words,
                         std::string help, Access access) {
  SettingOf<Target> setting;
  setting.kind = SettingOf<Target>::Kind::choice;
  setting.name = name;
  setting.help = std::move(help);
  for (const auto& [word, value] : words) setting.words.push_back(word);
  setting.value = fmt::format("{}", fmt::join(setting.words, "|"));
  setting.set = [access, words, known = setting.words](Target& target, const std::string& given) -> Status {
    for (const auto& [word, value] : words) {
      if (word != given) continue;
      access(target) = value;
      return Done{};
    }
    return usage_error(fmt::format("unknown word '{}'", given), suggestion(given, known));
  };
  setting.get = [access, words](const Target& target) -> std::vector<std::string> {
    for (const auto& [word, value] : words)
      if (access(target) == value) return {word};
    return {};
  };
  return setting;
}

/// A switch held in `access(target)`.
template <typename Target, typename Access>
SettingOf<Target> on_off(std::string_view name, std::string help, Access access, std::string opposite = "") {
  SettingOf<Target> setting = choice<Target, bool>(name, {{"true", true}, {"false", false}}, help, access);
  setting.kind = SettingOf<Target>::Kind::on_off;
  setting.value.clear();
  setting.opposite = std::move(opposite);
  return setting;
}

Status check_segment(const std::string& text) {
  const auto segment = parse_segment(text);
  return segment ? Status(Done{}) : Status(segment.error());
}

std::string word_of(Segment segment) { return std::string(name(segment)); }
std::string word_of(const Direction& direction) { return direction.text; }
std::string word_of(const std::optional<SceneKind>& scene) {
  return scene ? std::string(name(*scene)) : std::string();
}

/// A value held in `access(target)` that `parse` reads.
template <typename Target, typename Access, typename Parse>
SettingOf<Target> parsed(std::string_view name, std::string value, std::string help, Access access,
                         Parse parse) {
  SettingOf<Target> setting;
  setting.name = name;
  setting.value = std::move(value);
  setting.help = std::move(help);
  setting.set = [access, parse](Target& target, const std::string& given) -> Status {
    const auto held = parse(given);
    if (!held) return held.error();
    access(target) = *held;
    return Done{};
  };
  setting.get = [access](const Target& target) { return values_of(word_of(access(target))); };
  return setting;
}

Status add_to_map(HumanoidOptions& target, const std::string& segment, const std::string& node) {
  if (target.map.emplace(segment, node).second) return Done{};
  return usage_error(fmt::format("'{}' gets two nodes", segment), "give each segment one node");
}

bool names_map_file(std::string_view text) {
  return text.find('=') == text.npos && (text.ends_with(".toml") || text.ends_with(".json"));
}

Status take_map(HumanoidOptions& target, const std::string& text) {
  if (names_map_file(text)) {
    const auto map = read_map(text);
    if (!map) return map.error();
    for (const auto& [segment, node] : *map)
      if (const Status added = add_to_map(target, segment, node); !added) return added.error();
    return Done{};
  }
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size())
    return usage_error(fmt::format("'{}' is not SEGMENT=NODE, and no .toml or .json file", text),
                       "write head=NodeName or head=#12");
  const std::string segment = text.substr(0, equals);
  if (const Status known = check_segment(segment); !known) return known.error();
  return add_to_map(target, segment, text.substr(equals + 1));
}

HumanoidSetting map_setting() {
  HumanoidSetting setting;
  setting.kind = HumanoidSetting::Kind::list;
  setting.name = "map";
  setting.value = "SEGMENT=NODE|FILE";
  setting.help =
      "which bone moves which segment, by the bone's name or #INDEX, where the program finds the wrong one "
      "or none; "
      "a .toml or .json file may name many, like the one that inspect --json prints";
  setting.set = take_map;
  setting.get = [](const HumanoidOptions& target) {
    std::vector<std::string> entries;
    for (const auto& [segment, node] : target.map) entries.push_back(segment + "=" + node);
    return entries;
  };
  return setting;
}

HumanoidSetting root_setting() {
  HumanoidSetting setting;
  setting.name = "root";
  setting.value = "NODE";
  setting.help =
      "where a file holds several figures: the node at or above the one to use, by its name or #INDEX";
  setting.unset = "the first";
  setting.set = [](HumanoidOptions& target, const std::string& text) -> Status {
    if (text.empty()) return usage_error("no node is named", "give a node's name, or its #INDEX in the file");
    target.root = text;
    return Done{};
  };
  setting.get = [](const HumanoidOptions& target) {
    return target.root.empty() ? std::vector<std::string>() : std::vector<std::string>{target.root};
  };
  return setting;
}

HumanoidSetting unit_setting() {
  static constexpr std::array<std::pair<const char*, double>, 6> kUnits = {
      {{"m", 1.0}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}}};
  HumanoidSetting setting;
  setting.name = "unit";
  setting.value = "UNIT";
  setting.help = "length unit of the file: m, dm, cm, mm, in, ft, or metres per unit";
  setting.unset = "found out";
  setting.set = [](HumanoidOptions& target, const std::string& text) -> Status {
    const auto unit =
        std::find_if(kUnits.begin(), kUnits.end(), [&](const auto& entry) { return text == entry.first; });
    const auto metres = unit == kUnits.end() ? number_in(text) : std::optional(unit->second);
    if (!metres || !Range{0.0, 1e6, true}.contains(*metres))
      return usage_error(fmt::format("'{}' is not a unit", text),
                         "give m, dm, cm, mm, in, ft, or metres per unit");
    target.metres_per_unit = *metres;
    return Done{};
  };
  setting.get = [](const HumanoidOptions& target) { return values_of(target.metres_per_unit); };
  return setting;
}

HumanoidSetting up_setting() {
  HumanoidSetting setting = choice<HumanoidOptions, std::optional<char>>(
      "up", {{"y", 'y'}, {"z", 'z'}}, "up axis of the file", [](auto& t) -> auto& { return t.up_axis; });
  setting.unset = "found out";
  return setting;
}

HumanoidSetting height_setting() {
  HumanoidSetting setting = number<HumanoidOptions>(
      "height", "M", Range{0.05, 50.0}, "height of the character, sole to crown",
      [](auto& t) -> auto& { return t.height_m; });
  setting.unset = "found out";
  return setting;
}

/// The same setting, of a bake's humanoid options.
Setting lifted(const HumanoidSetting& inner) {
  Setting setting;
  setting.kind = static_cast<Setting::Kind>(inner.kind);
  setting.name = inner.name;
  setting.value = inner.value;
  setting.help = inner.help;
  setting.unset = inner.unset;
  setting.range = inner.range;
  setting.words = inner.words;
  setting.set = [set = inner.set](BakeSettings& s, const std::string& text) { return set(s.humanoid, text); };
  setting.get = [get = inner.get](const BakeSettings& s) { return get(s.humanoid); };
  return setting;
}

using Settings = std::vector<Setting>;

Setting with_unset(Setting setting, std::string unset) {
  setting.unset = std::move(unset);
  return setting;
}

/// A setting whose value may be left out on the command line.
Setting bare(Setting setting, std::string value) {
  setting.bare = std::move(value);
  return setting;
}

Settings hit_settings() {
  using S = BakeSettings;
  return {
      parsed<S>(
          "hit", "SEGMENT",
          "what is hit: head torso waist hips shoulder_l upper_arm_l lower_arm_l hand_l upper_leg_l calf_l "
          "foot_l, or _r; the paper's names (chest, abdomen, pelvis, thigh_l, shank_l) do as well",
          [](auto& s) -> auto& { return s.hit; }, parse_segment),
      parsed<S>(
          "from", "DIR",
          "where the blow comes from: front back left right above front_left ..., or AZIMUTH[,ELEVATION] in "
          "degrees, 0 = "
          "from the front, 90 = from the character's left [-360 to 360, -90 to 90]",
          [](auto& s) -> auto& { return s.from; }, parse_direction),
      text<S>(
          "preset", "NAME",
          "what hits, with the momentum of the real thing: punch kick medicine-ball football tackle shot "
          "trip "
          "slip pull explosion",
          [](auto& s) -> auto& { return s.preset; }, check_preset),
      with_unset(number<S>(
                     "ball-mass", "KG", Range{0.001, 10000.0}, "mass of the ball or box",
                     [](auto& s) -> auto& { return s.ball_mass_kg; }),
                 "the preset's"),
      with_unset(number<S>(
                     "ball-speed", "M_S", Range{0.01, 1000.0}, "speed of the ball or box at contact",
                     [](auto& s) -> auto& { return s.ball_speed_m_s; }),
                 "the preset's"),
      with_unset(number<S>(
                     "ball-radius", "M", Range{0.005, 5.0}, "radius of the ball, or half the edge of the box",
                     [](auto& s) -> auto& { return s.ball_radius_m; }),
                 "the preset's"),
      number<S>(
          "strength", "TIMES", Range{0.01, 100.0}, "strength of the blow: times the preset's momentum",
          [](auto& s) -> auto& { return s.strength; }),
      number<S>(
          "aim-up", "M", Range{-5.0, 5.0}, "ball and box: how far above its centre the segment is hit",
          [](auto& s) -> auto& { return s.aim_up_m; }),
      number<S>(
          "aim-left", "M", Range{-5.0, 5.0},
          "ball and box: how far left of its centre the segment is hit, seen from where the blow comes",
          [](auto& s) -> auto& { return s.aim_left_m; }),
      with_unset(parsed<S>(
                     "scene", "ball|slope|fall|push|impulse|box|none|trip|slip|pull|explosion",
                     "what happens. ball: a ball flies in; slope: a ball rolls down a ramp; fall: the body "
                     "is tipped over "
                     "or dropped; push: a force acts for a time; impulse: momentum is given at once; box: a "
                     "box slides in; "
                     "none: nothing; trip: a foot is caught; slip: the feet slip away to where --from says; "
                     "pull: the body "
                     "is pulled there; explosion: the whole body is blown away",
                     [](auto& s) -> auto& { return s.scene; }, parse_scene),
                 "the preset's"),
      number<S>(
          "slope-deg", "DEG", Range{1.0, 60.0}, "slope of the ramp (--scene slope)",
          [](auto& s) -> auto& { return s.slope_deg; }),
      number<S>(
          "fall-height", "M", Range{0.0, 50.0}, "height from which the body is dropped (--scene fall)",
          [](auto& s) -> auto& { return s.fall_height_m; }),
      number<S>(
          "tip-speed", "M_S", Range{0.0, 20.0},
          "speed at which the body is tipped over, away from --from (--scene fall)",
          [](auto& s) -> auto& { return s.tip_speed_m_s; }),
  };
}

Settings body_settings() {
  using S = BakeSettings;
  Settings settings = {
      with_unset(number<S>(
                     "mass", "KG", Range{0.001, 10000.0}, "mass of the body",
                     [](auto& s) -> auto& { return s.mass_kg; }),
                 "73 kg (height / 1.741 m)^3, female 61.9 kg (height / 1.735 m)^3"),
      choice<S, Sex>(
          "sex", {{"male", Sex::male}, {"female", Sex::female}},
          "whether the segments have the masses of a man or a woman", [](auto& s) -> auto& { return s.sex; }),
  };
  for (const HumanoidSetting& setting : humanoid_settings()) settings.push_back(lifted(setting));
  return settings;
}

Settings start_settings() {
  using S = BakeSettings;
  return {
      with_unset(text<S>(
                     "pose", "rest|stand|guard|FILE",
                     "still pose to start from: a word, or the first frame (without clips the rest pose) of "
                     "another humanoid's .bvh .glb .gltf .vrm .fbx .dae file",
                     [](auto& s) -> auto& { return s.pose; }),
                 "stand; a file that only has motion starts from its own clip"),
      text<S>(
          "clip", "NAME|FILE[#NAME]",
          "motion to start from: a clip of the file, by its name or #INDEX, or of another humanoid's file "
          "(its "
          "first, unless named after '#'), carried over to the character",
          [](auto& s) -> auto& { return s.clip; }),
      with_unset(number<S>(
                     "at", "S", Range{0.0, 86400.0}, "time in the start clip at which the blow lands",
                     [](auto& s) -> auto& { return s.at_s; }),
                 "0"),
      with_unset(
          number<S>(
              "ground-speed", "M_S", Range{0.0, 20.0},
              "speed over the ground of a start clip that walks or runs on the spot; 0 leaves it there",
              [](auto& s) -> auto& { return s.ground_speed_m_s; }),
          "found out from its feet"),
  };
}

constexpr std::array<std::pair<std::string_view, Knockout::At>, 3> kKnockouts = {
    {{"blow", Knockout::At::blow}, {"step", Knockout::At::step}, {"landing", Knockout::At::landing}}};

Result<Knockout> parse_knockout(const std::string& text) {
  for (const auto& [word, at] : kKnockouts)
    if (word == text) return Knockout{at, 0.0};
  const auto time_s = number_in(text);
  if (!time_s || !Range{0.0, 60.0}.contains(*time_s))
    return usage_error(fmt::format("'{}' is neither a time from 0 to 60 nor a word", text),
                       "give seconds after the blow, or blow, step, landing");
  return Knockout{Knockout::At::time, *time_s};
}

Setting knockout_setting() {
  Setting setting;
  setting.name = "knockout-at";
  setting.value = "S|blow|step|landing";
  setting.help =
      "when the body is knocked out and goes limp: S after the blow, at the blow, once the first step is "
      "down or balance is lost, or once the fall has landed [0 to 60]";
  setting.unset = "never";
  setting.set = [](BakeSettings& settings, const std::string& text) -> Status {
    const auto knockout = parse_knockout(text);
    if (!knockout) return knockout.error();
    settings.knockout = *knockout;
    return Done{};
  };
  setting.get = [](const BakeSettings& settings) -> std::vector<std::string> {
    if (!settings.knockout) return {};
    for (const auto& [word, at] : kKnockouts)
      if (at == settings.knockout->at) return {std::string(word)};
    return {fmt::format("{}", settings.knockout->time_s)};
  };
  return setting;
}

Settings behaviour_settings_table() {
  using S = BakeSettings;
  return {
      with_unset(choice<S, std::optional<Behaviour>>(
                     "behaviour",
                     {{"alert", Behaviour::alert}, {"dazed", Behaviour::dazed}, {"limp", Behaviour::limp}},
                     "alert: balances, steps, protects itself; dazed: late and weak, one step to keep "
                     "its balance; limp: "
                     "nobody is in the body, and --stiffness holds its pose at first",
                     [](auto& s) -> auto& { return s.behaviour; }),
                 "alert, or limp with --rate fixed"),
      number<S>(
          "steps", "N", Range{0.0, 20.0},
          "most recovery steps; 0: the feet stay planted, and the stand pose leans into the blow",
          [](auto& s) -> auto& { return s.most_steps; }),
      choice<S, std::optional<Wanted>>(
          "outcome", {{"auto", std::nullopt}, {"stand", Wanted::stand}, {"fall", Wanted::fall}},
          "stand, fall: searches for a take that ends so (--search); auto: takes what the blow leads to",
          [](auto& s) -> auto& { return s.outcome; }),
      with_unset(number<S>(
                     "search", "N", Range{1.0, 100.0},
                     "most trials of a search over first foot, step times and tension; the trial that moves "
                     "most like a "
                     "person is kept",
                     [](auto& s) -> auto& { return s.search; }),
                 "1, with --outcome 5"),
      on_off<S>(
          "assist",
          "where no trial reaches the outcome, a force on the pelvis helps, as small as will do; the report "
          "says how much",
          [](auto& s) -> auto& { return s.assist; }),
      choice<S, HoldingArms>(
          "arms",
          {{"none", HoldingArms::none},
           {"left", HoldingArms::left},
           {"right", HoldingArms::right},
           {"both", HoldingArms::both}},
          "arms that hold something: they neither swing nor catch the body",
          [](auto& s) -> auto& { return s.arms; }),
      number<S>(
          "muscle", "TIMES", Range{0.1, 10.0}, "muscle strength, of a healthy adult's",
          [](auto& s) -> auto& { return s.muscle; }),
      with_unset(
          number<S>(
              "latency", "S", Range{0.0, 2.0}, "time from the blow to the first reaction of the balance",
              [](auto& s) -> auto& { return s.latency_s; }),
          "0.10, dazed 0.20"),
      knockout_setting(),
      on_off<S>(
          "breath", "a living body that lies still breathes for 1 s before the clip ends",
          [](auto& s) -> auto& { return s.breathes; }, "lies still, and the clip ends with --hold"),
      bare(with_unset(number<S>(
                          "get-up", "S", Range{0.0, 60.0},
                          "get up from the floor into the start pose, after lying still for this time",
                          [](auto& s) -> auto& { return s.get_up_s; }),
                      "stays down"),
           "0.8"),
      choice<S, GetUpStyle>(
          "get-up-style",
          {{"plain", GetUpStyle::plain},
           {"quick", GetUpStyle::quick},
           {"heavy", GetUpStyle::heavy},
           {"hurt", GetUpStyle::hurt}},
          "manner of getting up", [](auto& s) -> auto& { return s.get_up_style; }),
      text<S>(
          "get-up-clip", "FILE[#NAME]|DIR",
          "get up as somebody did: the get-up of a file or a folder that begins nearest to how the body lies "
          "leads it, "
          "where it is in reach; it ends as the clip ends (implies --get-up)",
          [](auto& s) -> auto& { return s.get_up_clip; }),
      number<S>(
          "seed", "N", Range{0.0, 4294967295.0},
          "another take of the same blow: stance, latency, arms and steps vary as people do; 0: the mean of "
          "all",
          [](auto& s) -> auto& { return s.seed; }),
  };
}

Setting rate_setting() {
  Setting setting;
  setting.name = "rate";
  setting.value = "adaptive|fixed:HZ";
  setting.help = "time steps of the simulation [HZ 60 to 10000]";
  setting.set = [](BakeSettings& settings, const std::string& text) -> Status {
    const std::string prefix = "fixed:";
    if (text != "adaptive" && !text.starts_with(prefix))
      return usage_error(fmt::format("unknown word '{}'", text), "give adaptive or fixed:HZ");
    const auto hz = text == "adaptive" ? Result<double>(0.0)
                                       : parse_number(text.substr(prefix.size()), Range{60.0, 10000.0});
    if (!hz) return hz.error();
    settings.simulation.fixed_hz = *hz;
    return Done{};
  };
  setting.get = [](const BakeSettings& settings) -> std::vector<std::string> {
    const double hz = settings.simulation.fixed_hz;
    return {hz > 0.0 ? fmt::format("fixed:{}", hz) : "adaptive"};
  };
  return setting;
}

Settings method_settings() {
  using S = BakeSettings;
  return {
      choice<S, Limits>(
          "limits", {{"edges", Limits::edges}, {"segments", Limits::segments}, {"axis", Limits::axis}},
          "how the range of motion is kept", [](auto& s) -> auto& { return s.simulation.limits; }),
      text<S>(
          "region", "NAME|FILE", "range of motion: human diamond box, or a TOML file",
          [](auto& s) -> auto& { return s.region; }),
      choice<S, Active>(
          "active",
          {{"implicit", Active::implicit}, {"explicit", Active::explicit_torque}, {"off", Active::off}},
          "active restriction: joints resist fast rotation, like a person who tenses up",
          [](auto& s) -> auto& { return s.simulation.active; }),
      number<S>(
          "active-k", "1_S", Range{0.0, 2000.0, true}, "strength k of the active restriction",
          [](auto& s) -> auto& { return s.simulation.active_k; }),
      with_unset(text<S>(
                     "active-file", "FILE", "thresholds of the active restriction, as calibrate writes them",
                     [](auto& s) -> auto& { return s.active_file; }),
                 "the program's own"),
      number<S>(
          "active-delay", "S", Range{0.0, 10.0}, "time after the blow before the active restriction sets in",
          [](auto& s) -> auto& { return s.simulation.active_delay_s; }),
      with_unset(number<S>(
                     "tone", "0..1", Range{0.0, 1.0},
                     "stiffness at first: share of a person's joint torques that hold the start pose",
                     [](auto& s) -> auto& { return s.simulation.tone; }),
                 "0.3, or 0 with --rate fixed"),
      number<S>(
          "tone-fade", "S", Range{0.0, 10.0, true}, "time in which the stiffness at first fades away",
          [](auto& s) -> auto& { return s.simulation.tone_fade_s; }),
      with_unset(number<S>(
                     "damping", "1_S", Range{0.0, 100.0}, "joint damping",
                     [](auto& s) -> auto& { return s.simulation.damping; }),
                 "10, or 0 with --rate fixed"),
      rate_setting(),
  };
}

Settings clip_settings() {
  using S = BakeSettings;
  return {
      with_unset(number<S>(
                     "duration", "S", Range{0.0, 60.0, true}, "longest time that is simulated after the blow",
                     [](auto& s) -> auto& { return s.simulation.duration_s; }),
                 "4, limp 3, with --get-up 12"),
      on_off<S>(
          "until-rest", "end the clip once everything rests", [](auto& s) -> auto& { return s.until_rest; },
          "keep the still tail, up to --duration"),
      number<S>(
          "hold", "S", Range{0.0, 60.0}, "time that the clip goes on once everything rests",
          [](auto& s) -> auto& { return s.hold_s; }),
      number<S>(
          "fps", "N", Range{1.0, 1000.0}, "frames per second",
          [](auto& s) -> auto& { return s.simulation.fps; }),
      number<S>(
          "lead", "S", Range{0.0, 60.0},
          "start of the clip before the impact: the start clip (round and round where it is a cycle), or the "
          "pose held",
          [](auto& s) -> auto& { return s.lead_s; }),
      with_unset(number<S>(
                     "recover", "S", Range{0.0, 60.0, true},
                     "blend from the end of the simulation back to the start, in this time",
                     [](auto& s) -> auto& { return s.recover_s; }),
                 "none"),
      choice<S, RecoverTo>(
          "to", {{"stance", RecoverTo::stance}, {"rest", RecoverTo::rest}, {"clip", RecoverTo::clip}},
          "how the clip ends. rest: in the start pose (with --return); clip: in the start clip as it has run "
          "on, and a walking body goes on walking with it (also without --return); stance: standing, as the "
          "body "
          "came to stand",
          [](auto& s) -> auto& { return s.recover_to; }),
      choice<S, RootMotion>(
          "root-motion",
          {{"hips", RootMotion::hips}, {"root", RootMotion::root}, {"in-place", RootMotion::in_place}},
          "motion over the ground: on the hips, on the skin's root joint above them (of a glTF or FBX; added "
          "where "
          "there is none), or left out (the report keeps it)",
          [](auto& s) -> auto& { return s.ground.root_motion; }),
      on_off<S>(
          "align", "turn and move the clip so that it starts at the origin, facing +z",
          [](auto& s) -> auto& { return s.ground.align; }),
      choice<S, Additive>(
          "additive", {{"off", Additive::off}, {"identity", Additive::identity}, {"rest", Additive::rest}},
          "glTF clip as the difference from its first frame: alone (three.js, Babylon.js), or on top of the "
          "rest "
          "pose (Godot 4, Flax); Unity and Unreal take the plain clip and make it additive, base pose frame "
          "0",
          [](auto& s) -> auto& { return s.additive; }),
      choice<S, bool>(
          "extra-bones", {{"hold", false}, {"clip", true}},
          "bones of no segment (fingers, face): hold their pose at the impact, or play the start clip on",
          [](auto& s) -> auto& { return s.extra_bones_play; }),
      with_unset(number<S>(
                     "smooth", "HZ", Range{0.5, 500.0},
                     "zero-phase low-pass after the impact, -6 dB at HZ (below half of --fps)",
                     [](auto& s) -> auto& { return s.smooth_hz; }),
                 "off"),
      choice<S, bool>(
          "keys", {{"reduced", true}, {"all", false}}, "keys of a glTF clip",
          [](auto& s) -> auto& { return s.keys.enabled; }),
      number<S>(
          "key-error-mm", "MM", Range{0.0, 1000.0, true}, "how far reduced keys may move a joint",
          [](auto& s) -> auto& { return s.keys.tolerance_m; }, 0.001),
  };
}

Settings out_settings() {
  using S = BakeSettings;
  return {
      choice<S, bool>(
          "rotation-type", {{"float", false}, {"int16", true}},
          "numbers of a glTF clip's rotations; int16 halves them, within the same error",
          [](auto& s) -> auto& { return s.keys.short_rotations; }),
      on_off<S>(
          "clip-only", "glTF or FBX of skeleton and clip, without the mesh",
          [](auto& s) -> auto& { return s.clip_only; }),
      on_off<S>(
          "all-joints", "keys for every joint of the skin in a glTF, two where it rests (an FBX has them)",
          [](auto& s) -> auto& { return s.all_joints; }),
      with_unset(choice<S, std::optional<double>>(
                     "bvh-unit", {{"cm", 0.01}, {"m", 1.0}},
                     "length unit of a .bvh that is written; a character from a BVH keeps that of its file",
                     [](auto& s) -> auto& { return s.bvh_metres_per_unit; }),
                 "cm"),
  };
}

void append(Settings& settings, std::string_view group, Settings more) {
  for (Setting& setting : more) {
    setting.group = group;
    setting.also = other_words(setting.name);
    setting.everyday = is_everyday(setting.name);
  }
  std::move(more.begin(), more.end(), std::back_inserter(settings));
}

Settings all_settings() {
  Settings settings;
  append(settings, "hit", hit_settings());
  append(settings, "body", body_settings());
  append(settings, "start", start_settings());
  append(settings, "behaviour", behaviour_settings_table());
  append(settings, "method", method_settings());
  append(settings, "clip", clip_settings());
  append(settings, "out", out_settings());
  return settings;
}

}  // namespace

const std::vector<HumanoidSetting>& humanoid_settings() {
  static const std::vector<HumanoidSetting> settings = {map_setting(), root_setting(), unit_setting(),
                                                        up_setting(), height_setting()};
  return settings;
}

const std::vector<Setting>& bake_settings() {
  static const std::vector<Setting> settings = all_settings();
  return settings;
}

Result<const Setting*> find_setting(std::string_view name) {
  std::vector<std::string> names;
  for (const Setting& setting : bake_settings()) {
    names.emplace_back(setting.name);
    names.insert(names.end(), setting.also.begin(), setting.also.end());
    if (std::find(names.rbegin(), names.rend(), name) != names.rend()) return &setting;
  }
  return usage_error(fmt::format("unknown setting '{}'", name), suggestion(name, names));
}

Status check_values(const BakeSettings& settings) {
  BakeSettings copy;
  for (const Setting& setting : bake_settings()) {
    for (const std::string& value : setting.get(settings)) {
      const Status status = setting.set(copy, value);
      if (status) continue;
      Error error = status.error();
      error.what = fmt::format("{}: {}", setting.name, error.what);
      return error;
    }
  }
  return Done{};
}

}  // namespace ukemi
