// BVH (Biovision hierarchy): a tree of joints with offsets and channels, then one row of numbers per frame.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/base64.h"
#include "base/errors.h"
#include "load/load.h"
#include "load/text.h"

namespace ukemi {
namespace {

Error error_in_line(const std::filesystem::path& path, int line, std::string what, std::string fix) {
  Error error = input_error(path, std::move(what), std::move(fix));
  error.line = line;
  return error;
}

using load::quoted;
using load::same_word;

constexpr int kMaxDepth = 1000;
constexpr long kMaxChannelsPerJoint = 6;
constexpr std::size_t kMostNumbers = 100'000'000;  // of the motion: 2 to 5 GB
constexpr double kLongest_s = 86400.0;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Position in a text and the line (1-based) it is on.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  int line() const { return line_; }
  bool at_end() const { return position_ >= text_.size(); }

  /// Next word, or a brace alone; empty at the end of the text.
  std::string_view word() {
    skip_space();
    const std::size_t start = position_;
    if (!at_end() && is_brace(text_[position_])) return text_.substr(position_++, 1);
    while (!at_end() && !is_blank(text_[position_]) && text_[position_] != '\n' &&
           !is_brace(text_[position_]))
      ++position_;
    return text_.substr(start, position_ - start);
  }

  /// What is left of the line before an opening brace, trimmed: names may have spaces.
  std::string_view name() {
    const std::size_t start = position_;
    while (!at_end() && text_[position_] != '\n' && text_[position_] != '{') ++position_;
    return trimmed(text_.substr(start, position_ - start));
  }

  /// The rest of the line, without its end; the scanner goes to the next line. Its number is line() before
  /// the call.
  std::string_view rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    const std::string_view rest = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    if (end < text_.size()) ++line_;
    return rest;
  }

  void skip_space() {
    for (; !at_end() && (is_blank(text_[position_]) || text_[position_] == '\n'); ++position_)
      if (text_[position_] == '\n') ++line_;
  }

  std::size_t bytes_left() const { return text_.size() - position_; }

 private:
  static bool is_brace(char c) { return c == '{' || c == '}'; }

  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
};

bool is_rotation(BvhChannel channel) { return channel >= BvhChannel::x_rotation; }
int axis_of(BvhChannel channel) { return static_cast<int>(channel) % 3; }

std::optional<BvhChannel> channel_named(std::string_view word) {
  static constexpr std::array<std::string_view, 6> kNames{"Xposition", "Yposition", "Zposition",
                                                          "Xrotation", "Yrotation", "Zrotation"};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (same_word(word, kNames[i])) return static_cast<BvhChannel>(i);
  return std::nullopt;
}

/// What this program writes into the name of an End Site ("unit=0.01m,up=y,clip=eyJ1...").
struct FileMark {
  std::optional<double> metres_per_unit;
  std::string extras_json;
};

std::optional<double> unit_in(std::string_view mark) {
  constexpr std::string_view kBefore = "unit=", kAfter = "m,up=y";
  if (!mark.starts_with(kBefore) || !mark.ends_with(kAfter)) return std::nullopt;
  mark.remove_prefix(kBefore.size());
  if (mark.size() <= kAfter.size()) return std::nullopt;
  mark.remove_suffix(kAfter.size());
  const auto unit = load::whole_number(mark);
  return unit && *unit > 0.0 ? unit : std::nullopt;
}

FileMark mark_in(std::string_view name) {
  constexpr std::string_view kClip = "clip=";
  const std::size_t clip = name.starts_with(kClip) ? 0 : name.find(",clip=");
  if (clip == name.npos) return {unit_in(name), ""};
  FileMark mark{unit_in(name.substr(0, clip)), ""};
  const Base64Bytes bytes = base64_decoded(name.substr(name.find('=', clip) + 1));
  if (bytes.whole()) mark.extras_json.assign(bytes.bytes.begin(), bytes.bytes.end());
  return mark;
}

/// Reads one file. Every function leaves the scanner just after what it read.
class BvhReader {
 public:
  BvhReader(std::string_view text, const std::filesystem::path& path, Diagnostics& diagnostics)
      : scanner_(text), path_(path), diagnostics_(diagnostics) {}

  Status read() {
    if (Status s = read_hierarchy(); !s) return s;
    if (Status s = read_motion_head(); !s) return s;
    return read_rows();
  }

  Skeleton skeleton;
  BvhSource source;
  double fps = 0.0;
  FileMark mark;  // the last one that is not empty

 private:
  /// A joint whose closing brace has not come yet.
  struct Open {
    int joint = -1;
    bool has_offset = false;
    bool has_channels = false;
    bool has_child = false;
  };

  Error error(int line, std::string what, std::string fix) const {
    return error_in_line(path_, line, std::move(what), std::move(fix));
  }
  Error joint_error(int joint, std::string what, std::string fix) const {
    Error e = error(scanner_.line(), std::move(what), std::move(fix));
    e.joint = skeleton.nodes[joint].name;
    return e;
  }
  Error expected(std::string_view what, std::string_view found) const {
    return error(
        scanner_.line(),
        fmt::format("{} expected, found {}", what, found.empty() ? "the end of the file" : quoted(found)),
        "correct the file, or export it again as BVH");
  }

  Status expect_word(std::string_view keyword) {
    const std::string_view word = scanner_.word();
    if (!same_word(word, keyword)) return expected(keyword, word);
    return Done{};
  }

  Status read_hierarchy() {
    if (Status s = expect_word("HIERARCHY"); !s) return s;
    if (Status s = expect_word("ROOT"); !s) return s;
    if (Status s = open_joint(); !s) return s;
    while (!open_.empty())
      if (Status s = read_item(); !s) return s;
    if (channel_count() == 0)
      return error(scanner_.line(), "no joint has channels", "use a file with motion in its CHANNELS");
    return Done{};
  }

  Status open_joint() {
    const int parent = open_.empty() ? -1 : open_.back().joint;
    skeleton.nodes.push_back({load::utf8_name(scanner_.name()), parent, {}});
    source.channels.emplace_back();
    source.end_site.emplace_back();
    if (!open_.empty()) open_.back().has_child = true;
    if (static_cast<int>(open_.size()) >= kMaxDepth)
      return error(scanner_.line(), fmt::format("joints are nested deeper than {}", kMaxDepth),
                   "use a file with fewer joints in a row");
    if (skeleton.nodes.size() > load::kMostNodes)
      return error(scanner_.line(), fmt::format("has more than {} joints", load::kMostNodes),
                   "use a file with fewer joints");
    if (Status s = expect_word("{"); !s) return s;
    open_.push_back({skeleton.size() - 1});
    return Done{};
  }

  Status read_item() {
    const std::string_view word = scanner_.word();
    if (same_word(word, "OFFSET")) return read_offset();
    if (same_word(word, "CHANNELS")) return read_channels();
    if (same_word(word, "JOINT")) return open_joint();
    if (same_word(word, "End")) return read_end_site();
    if (word == "}") return close_joint();
    return expected("OFFSET, CHANNELS, JOINT, End Site or }", word);
  }

  Status close_joint() {
    if (!open_.back().has_offset)
      return joint_error(open_.back().joint, "has no OFFSET", "add the joint's OFFSET line");
    open_.pop_back();
    return Done{};
  }

  Result<double> read_number(std::string_view what) {
    const std::string_view word = scanner_.word();
    const auto number = load::whole_number(word);
    if (!number) return expected(what, word);
    return *number;
  }

  Result<Vec3> read_vector() {
    Vec3 vector;
    for (double& component : vector) {
      const Result<double> number = read_number("a finite number of OFFSET");
      if (!number) return number.error();
      component = *number;
    }
    return vector;
  }

  Status read_offset() {
    Open& joint = open_.back();
    if (joint.has_offset) return joint_error(joint.joint, "has two OFFSETs", "remove one of them");
    const Result<Vec3> offset = read_vector();
    if (!offset) return offset.error();
    skeleton.nodes[joint.joint].rest.translation = *offset;
    joint.has_offset = true;
    return Done{};
  }

  Status read_channels() {
    Open& joint = open_.back();
    if (joint.has_child)
      return joint_error(joint.joint, "has its CHANNELS after a child",
                         "move CHANNELS before the first JOINT or End Site");
    if (joint.has_channels) return joint_error(joint.joint, "has two CHANNELS lines", "remove one of them");
    const Result<double> count = read_number("a number of channels");
    if (!count) return count.error();
    if (*count < 0 || *count > kMaxChannelsPerJoint || *count != std::floor(*count))
      return joint_error(joint.joint, fmt::format("has {} channels", *count), "give it 0 to 6 channels");
    std::vector<BvhChannel>& channels = source.channels[joint.joint];
    for (int i = 0; i < static_cast<int>(*count); ++i) {
      const std::string_view word = scanner_.word();
      const auto channel = channel_named(word);
      if (!channel) return expected("a channel (Xposition ... Zrotation)", word);
      if (std::find(channels.begin(), channels.end(), *channel) != channels.end())
        return joint_error(joint.joint, fmt::format("has channel {} twice", quoted(word)),
                           "name each channel once");
      channels.push_back(*channel);
    }
    joint.has_channels = true;
    return Done{};
  }

  Status read_end_site() {
    const int joint = open_.back().joint;
    const std::string_view kind = scanner_.name();
    if (!same_word(kind.substr(0, 4), "Site")) return expected("Site after End", kind);
    FileMark said = mark_in(trimmed(kind.substr(4)));
    if (said.metres_per_unit || !said.extras_json.empty()) mark = std::move(said);
    if (Status s = expect_word("{"); !s) return s;
    if (Status s = expect_word("OFFSET"); !s) return s;
    const Result<Vec3> offset = read_vector();
    if (!offset) return offset.error();
    if (source.end_site[joint])
      diagnostics_.warn(path_.string(), fmt::format("joint '{}' has several End Sites; the first one is kept",
                                                    skeleton.nodes[joint].name));
    else
      source.end_site[joint] = *offset;
    open_.back().has_child = true;
    return expect_word("}");
  }

  std::size_t channel_count() const {
    std::size_t count = 0;
    for (const auto& channels : source.channels) count += channels.size();
    return count;
  }

  /// The number after "KEYWORD :" on a line of its own, as text.
  Result<std::string_view> read_field(std::string_view keyword) {
    scanner_.skip_space();
    const int line = scanner_.line();
    const std::string_view text = scanner_.rest_of_line();
    const std::size_t colon = text.find(':');
    if (colon == text.npos || !same_word(trimmed(text.substr(0, colon)), keyword))
      return error(line, fmt::format("'{}:' expected, found {}", keyword, quoted(trimmed(text))),
                   "correct the MOTION section");
    return trimmed(text.substr(colon + 1));
  }

  Status read_motion_head() {
    const std::string_view word = scanner_.word();
    if (same_word(word, "ROOT"))
      return error(scanner_.line(), "has a second ROOT", "keep one skeleton per file");
    if (!same_word(word, "MOTION")) return expected("MOTION", word);
    const Result<std::string_view> frames = read_field("Frames");
    if (!frames) return frames.error();
    frames_line_ = scanner_.line() - 1;
    const auto count = load::whole_number(*frames);
    if (!count || *count < 1 || *count > 1e9 || *count != std::floor(*count))
      return error(frames_line_, fmt::format("announces {} frames", quoted(*frames)),
                   "give 'Frames:' the number of rows, at least 1");
    announced_ = static_cast<std::size_t>(*count);
    const Result<std::string_view> time = read_field("Frame Time");
    if (!time) return time.error();
    const auto seconds = load::whole_number(*time);
    if (!seconds || *seconds <= 0.0 || *seconds > 3600.0)
      return error(frames_line_ + 1, fmt::format("has frame time {}", quoted(*time)),
                   "give 'Frame Time:' the seconds between rows, as in 0.0333333");
    if (*seconds * static_cast<double>(announced_) > kLongest_s)
      return error(frames_line_ + 1,
                   fmt::format("lasts {:g} s, longer than a day", *seconds * static_cast<double>(announced_)),
                   "cut the motion into shorter files");
    if (*seconds > 1.0 && announced_ > 1)
      diagnostics_.warn(
          path_.string(),
          fmt::format("has less than one frame a second (Frame Time {}); the format wants seconds, "
                      "as in 0.0333333",
                      quoted(*time)));
    if (*seconds < 0.0005)
      diagnostics_.warn(
          path_.string(),
          fmt::format("has {:.3g} frames a second (Frame Time {}); the format wants seconds, as in "
                      "0.0333333",
                      1.0 / *seconds, quoted(*time)));
    source.frame_time_s = *seconds;
    fps = rate_of(*time, *seconds);
    return Done{};
  }

  /// 1 / seconds, or the common frame rate of which `text` is the rounded frame time.
  static double rate_of(std::string_view text, double seconds) {
    const std::size_t point = text.find('.');
    const bool plain = text.find_first_of("eE") == text.npos;
    const std::size_t decimals = point == text.npos ? 0 : text.size() - point - 1;
    const double last_place = plain ? std::pow(10.0, -static_cast<double>(decimals)) : 0.0;
    for (const double rate :
         {24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 72.0, 90.0, 100.0, 120.0, 144.0, 200.0, 240.0}) {
      const double off = std::abs(seconds - 1.0 / rate);
      if (off * rate < 1e-9 || (off <= last_place && off * rate < 0.012)) return rate;
    }
    return 1.0 / seconds;
  }

  /// One row into `row`; `line` is its number.
  Status read_row(std::string_view text, int line, std::vector<double>& row) const {
    const std::size_t width = channel_count_;
    const char* const begin = text.data();
    while (true) {
      while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
      if (text.empty()) break;
      const auto number = load::leading_number(text);
      if (!number || (number->length < text.size() && !is_blank(text[number->length]))) {
        const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
        Error e =
            error(line, fmt::format("{} is not a finite number", quoted(word)), "write numbers as in -12.5");
        e.column = static_cast<int>(text.data() - begin) + 1;
        return e;
      }
      row.push_back(number->value);
      text.remove_prefix(number->length);
    }
    if (row.size() != width)
      return error(line, fmt::format("row has {} numbers; the joints have {} channels", row.size(), width),
                   "write one number per channel on each row");
    return Done{};
  }

  Status read_rows() {
    channel_count_ = channel_count();
    if (announced_ > kMostNumbers / channel_count_)
      return error(frames_line_,
                   fmt::format("announces {} frames of {} numbers, together more than {}", announced_,
                               channel_count_, kMostNumbers),
                   "cut the motion into shorter files");
    source.frames.reserve(std::min(announced_, scanner_.bytes_left() / (2 * channel_count_) + 1));
    std::size_t extra = 0;
    std::vector<double> row;
    for (scanner_.skip_space(); !scanner_.at_end(); scanner_.skip_space()) {
      const int line = scanner_.line();
      row.clear();
      row.reserve(channel_count_);
      if (Status s = read_row(scanner_.rest_of_line(), line, row); !s) return s;
      if (source.frames.size() < announced_)
        source.frames.push_back(row);
      else
        ++extra;
    }
    if (source.frames.size() < announced_)
      return error(scanner_.line(),
                   fmt::format("ends after {} of the {} rows that line {} announces", source.frames.size(),
                               announced_, frames_line_),
                   "correct 'Frames:' or use the complete file");
    if (extra > 0)
      diagnostics_.warn(path_.string(),
                        fmt::format("has {} more rows than the {} that line {} announces; they are "
                                    "left out",
                                    extra, announced_, frames_line_));
    return Done{};
  }

  Scanner scanner_;
  const std::filesystem::path& path_;
  Diagnostics& diagnostics_;
  std::vector<Open> open_;
  std::size_t announced_ = 0;
  std::size_t channel_count_ = 0;
  int frames_line_ = 0;
};

/// Rotation of the joint's channels, applied in the file's order: each turns about the axes that the ones
/// before it have turned.
Quat rotation_of(const std::vector<BvhChannel>& channels, const double* values) {
  Quat rotation = Quat::Identity();
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (is_rotation(channels[i]))
      rotation = rotation * Quat(Eigen::AngleAxisd(radians(values[i]), Vec3::Unit(axis_of(channels[i]))));
  return rotation;
}

/// Positions replace the joint's offset, axis by axis (as Blender reads them), or are added to it (as
/// three.js does).
Vec3 translation_of(const std::vector<BvhChannel>& channels, const double* values, const Vec3& offset,
                    bool add) {
  Vec3 translation = offset;
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (!is_rotation(channels[i]))
      translation[axis_of(channels[i])] = values[i] + (add ? offset[axis_of(channels[i])] : 0.0);
  return translation;
}

/// Whether the positions of joints below the root lie around zero rather than around the joints' offsets:
/// then they are meant to be added to the offsets.
bool positions_lie_around_zero(const BvhSource& source, const Skeleton& skeleton) {
  constexpr std::size_t kMostRows = 200;
  constexpr double kNearZero = 0.25;
  const std::size_t stride = source.frames.size() / kMostRows + 1;
  double to_zero = 0.0, to_offset = 0.0;
  std::size_t first = 0;
  for (int joint = 0; joint < skeleton.size(); ++joint) {
    const std::vector<BvhChannel>& channels = source.channels[joint];
    for (std::size_t row = 0; row < source.frames.size() && skeleton.nodes[joint].parent >= 0; row += stride)
      for (std::size_t i = 0; i < channels.size(); ++i) {
        if (is_rotation(channels[i])) continue;
        const double value = source.frames[row][first + i];
        to_zero += std::abs(value);
        to_offset += std::abs(value - skeleton.nodes[joint].rest.translation[axis_of(channels[i])]);
      }
    first += channels.size();
  }
  return to_zero < kNearZero * to_offset;
}

Animation animation_of(const BvhSource& source, const Skeleton& skeleton, double fps, std::string name) {
  const std::size_t frame_count = source.frames.size();
  Animation animation{std::move(name), 0.0, static_cast<double>(frame_count - 1) / fps, fps, {}};
  std::vector<double> times(frame_count);
  for (std::size_t i = 0; i < frame_count; ++i) times[i] = static_cast<double>(i) / fps;
  std::size_t first = 0;
  for (int joint = 0; joint < skeleton.size(); ++joint) {
    const std::vector<BvhChannel>& channels = source.channels[joint];
    const auto rotations = std::count_if(channels.begin(), channels.end(), is_rotation);
    if (rotations < static_cast<long>(channels.size())) {
      Track track{joint, TrackPath::translation, Interpolation::linear, times, {}};
      track.values.reserve(3 * frame_count);
      for (const auto& row : source.frames) {
        const bool add = source.positions_add && skeleton.nodes[joint].parent >= 0;
        const Vec3 t =
            translation_of(channels, row.data() + first, skeleton.nodes[joint].rest.translation, add);
        track.values.insert(track.values.end(), t.begin(), t.end());
      }
      animation.tracks.push_back(std::move(track));
    }
    if (rotations > 0) {
      Track track{joint, TrackPath::rotation, Interpolation::linear, times, {}};
      track.values.reserve(4 * frame_count);
      Quat last = Quat::Identity();
      for (const auto& row : source.frames) {
        last = nearest_sign(rotation_of(channels, row.data() + first), last);
        track.values.insert(track.values.end(), {last.x(), last.y(), last.z(), last.w()});
      }
      animation.tracks.push_back(std::move(track));
    }
    first += channels.size();
  }
  return animation;
}

/// A glTF document with the skeleton alone, nodes in file order.
std::string document_of(const Skeleton& skeleton) {
  using Json = nlohmann::ordered_json;
  Json nodes = Json::array();
  for (const Node& node : skeleton.nodes) {
    const Vec3& t = node.rest.translation;
    nodes.push_back({{"name", node.name}, {"translation", {t.x(), t.y(), t.z()}}});
  }
  for (int i = 1; i < skeleton.size(); ++i) nodes[skeleton.nodes[i].parent]["children"].push_back(i);
  const Json document{{"asset", {{"version", "2.0"}, {"generator", "ukemi"}}},
                      {"scene", 0},
                      {"scenes", {{{"nodes", {0}}}}},
                      {"nodes", std::move(nodes)}};
  return document.dump();
}

}  // namespace

Result<Character> read_bvh(std::string_view text, const std::filesystem::path& path,
                           Diagnostics& diagnostics) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return error_in_line(path, 1, "is UTF-16 text", "save it as UTF-8 or plain ASCII");
  std::string with_newlines;
  if (text.find('\n') == text.npos && text.find('\r') != text.npos) {
    with_newlines = text;
    std::replace(with_newlines.begin(), with_newlines.end(), '\r', '\n');
    text = with_newlines;
  }
  BvhReader reader(text, path, diagnostics);
  if (const Status status = reader.read(); !status) return status.error();

  Character character;
  character.name = path.stem().string();
  character.path = path;
  character.format = SourceFormat::bvh;
  character.skeleton = std::move(reader.skeleton);
  [[maybe_unused]] const bool sorted = character.skeleton.sort();
  assert(sorted && "joints are read parents first");
  reader.source.positions_add = positions_lie_around_zero(reader.source, character.skeleton);
  character.metres_per_unit = reader.mark.metres_per_unit;
  if (reader.mark.metres_per_unit) character.yup_from_file = Quat::Identity();
  character.animations.push_back(animation_of(reader.source, character.skeleton, reader.fps, character.name));
  character.animations.back().extras_json = std::move(reader.mark.extras_json);
  character.document.json = document_of(character.skeleton);
  character.document.folder = path.parent_path();
  character.bvh = std::move(reader.source);
  return character;
}

}  // namespace ukemi
