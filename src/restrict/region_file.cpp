// Regions as TOML: assets/limits/*.toml, the user's own, and single joints inside another document.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <array>
#include <cmath>

#include "base/errors.h"
#include "base/files.h"
#include "restrict/range_of_motion.h"
#include "restrict/region_tables.h"

namespace ukemi {
namespace {

constexpr std::size_t kMaxBytes = 1u << 20;
constexpr double kMaxSwing = radians(170.0);
constexpr double kUnitTolerance = 1e-3;  // table axes are rounded to four decimals

constexpr int kMostBases = 8;  // of one another

Result<RangeOfMotion> load_region(const std::string& name_or_file, int bases);

/// Reads one region file; the first fault stops it.
class RegionReader {
 public:
  /// `bases`: number of files that are based on this one.
  explicit RegionReader(std::string file, int bases = 0) : file_(std::move(file)), bases_(bases) {}

  Result<RangeOfMotion> read(const toml::table& table) {
    range_.name = file_;
    if (const auto base = table["base"].value<std::string>()) {
      if (bases_ >= kMostBases)
        return fail(table, "", fmt::format("more than {} regions are based on one another", kMostBases),
                    "base it on human, diamond or box");
      Result<RangeOfMotion> loaded = load_region(*base, bases_ + 1);
      if (!loaded) return loaded;
      start_from(std::move(*loaded));
      range_.name = file_;
    }
    if (table["units"].value_or<std::string>("deg") != "deg")
      return fail(table, "", "units must be \"deg\"", "write angles in degrees");
    const toml::array* joints = table["joint"].as_array();
    if (joints == nullptr)
      return fail(table, "", "has no [[joint]] table",
                  "give at least one joint, or use one of the regions human, diamond, box");
    if (Status status = read_joints(*joints); !status) return status.error();
    return mirror_missing(table);
  }

  /// Single joints of a whole range.
  Result<RangeOfMotion> change(RangeOfMotion range, const toml::array& joints) {
    start_from(std::move(range));
    if (Status status = read_joints(joints); !status) return status.error();
    std::string names;
    for (int j = 0; j < kJointCount; ++j)
      if (read_[j]) names += fmt::format("{}{}", names.empty() ? "" : ", ", name(joint_at(j)));
    if (!names.empty()) range_.name += " with " + names;
    return range_;
  }

 private:
  void start_from(RangeOfMotion range) {
    range_ = std::move(range);
    given_.fill(true);
  }

  Status read_joints(const toml::array& joints) {
    for (const toml::node& node : joints) {
      const toml::table* joint = node.as_table();
      if (joint == nullptr)
        return fail(node, "", "[[joint]] is not a table", "write [[joint]] and its keys below it");
      if (Status status = read_joint(*joint); !status) return status;
    }
    return Done{};
  }

  Error fail(const toml::node& where, std::string joint, std::string what, std::string fix) const {
    return error_at(where.source().begin,
                    error_about(std::move(joint), input_error(file_, std::move(what), std::move(fix))));
  }

  Status read_joint(const toml::table& table) {
    const std::string label = table["name"].value_or<std::string>("");
    const std::optional<Joint> joint = joint_named(label);
    if (!joint)
      return fail(table, label, "unknown joint",
                  "name one of spine chest neck clavicle_r shoulder_r elbow_r wrist_r hip_r knee_r ankle_r "
                  "or their _l");
    if (read_[index(*joint)]) return fail(table, label, "is given twice", "keep one [[joint]] table of it");
    JointRange& range = range_.joints[index(*joint)];
    if (Status s = read_frame(table, label, given_[index(*joint)], range.frame); !s) return s;
    if (Status s = read_polygon(table, label, range); !s) return s;
    if (Status s = read_twist(table, label, range); !s) return s;
    if (Status s = read_meanings(table, label, range); !s) return s;
    given_[index(*joint)] = true;
    read_[index(*joint)] = true;
    return Done{};
  }

  std::optional<Vec3> direction(const toml::table& table, const char* key) const {
    const toml::array* values = table[key].as_array();
    if (values == nullptr || values->size() != 3) return std::nullopt;
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = (*values)[i].value_or<double>(NAN);
    if (!v.allFinite() || std::abs(v.norm() - 1.0) > kUnitTolerance) return std::nullopt;
    return v;
  }

  Status read_frame(const toml::table& table, const std::string& label, bool has_base,
                    JointFrame& frame) const {
    if (has_base && !table.contains("x_axis") && !table.contains("y_axis") &&
        !table.contains("neutral_link_dir"))
      return Done{};
    const auto link = direction(table, "neutral_link_dir");
    const auto x = direction(table, "x_axis");
    const auto y = direction(table, "y_axis");
    if (!link || !x || !y)
      return fail(table, label, "needs neutral_link_dir, x_axis and y_axis: unit vectors [x, y, z]",
                  "copy them from the joint's table in human.toml");
    if (std::abs(x->dot(*y)) > kUnitTolerance)
      return fail(table, label, "x_axis and y_axis are not perpendicular", "copy them from human.toml");
    const Vec3 x_unit = x->normalized();
    const Vec3 z_unit = x_unit.cross(*y).normalized();
    Mat3 axes;
    axes << x_unit, z_unit.cross(x_unit), z_unit;
    frame.parent_from_joint = Quat(axes).normalized();
    frame.reference = shortest_rotation(*link, x_unit).normalized();
    return Done{};
  }

  Status read_polygon(const toml::table& table, const std::string& label, JointRange& range) const {
    const toml::node* node = table.get("polygon");
    if (node == nullptr && !range.polygon.empty()) return Done{};
    const toml::array* corners = node == nullptr ? nullptr : node->as_array();
    if (corners == nullptr || corners->size() < 3)
      return fail(table, label, "needs a polygon of at least 3 corners [a_y, a_z]",
                  "give corners in degrees, counter-clockwise");
    std::vector<Vec2> polygon;
    for (const toml::node& corner : *corners) {
      const toml::array* pair = corner.as_array();
      const Vec2 v = pair != nullptr && pair->size() == 2
                         ? Vec2((*pair)[0].value_or<double>(NAN), (*pair)[1].value_or<double>(NAN))
                         : Vec2(NAN, NAN);
      if (!v.allFinite())
        return fail(corner, label, "a corner is not a pair of numbers [a_y, a_z]", "give corners in degrees");
      polygon.push_back(v * radians(1.0));
      if (polygon.back().norm() > kMaxSwing)
        return fail(
            corner, label,
            fmt::format("corner [{:g}, {:g}] lies more than 170 degrees from the reference", v.x(), v.y()),
            "choose a reference direction in the middle of the range");
    }
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2& a = polygon[i];
      const Vec2& b = polygon[(i + 1) % polygon.size()];
      if (a.x() * b.y() - a.y() * b.x() > 1e-9) continue;
      return fail(
          *corners->get((i + 1) % polygon.size()), label,
          polygon_winds_backwards(polygon)
              ? "the polygon is not counter-clockwise"
              : "the polygon is not star-shaped about the reference, or the reference (0, 0) lies outside it",
          "order the corners by their direction from (0, 0), counter-clockwise, with (0, 0) inside");
    }
    range.polygon = std::move(polygon);
    return Done{};
  }

  static bool polygon_winds_backwards(const std::vector<Vec2>& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2& a = polygon[i];
      const Vec2& b = polygon[(i + 1) % polygon.size()];
      if (a.x() * b.y() - a.y() * b.x() >= 0.0) return false;
    }
    return true;
  }

  Status read_twist(const toml::table& table, const std::string& label, JointRange& range) const {
    const toml::node* node = table.get("alpha");
    if (node == nullptr && range.twist_max > range.twist_min) return Done{};
    const toml::array* pair = node == nullptr ? nullptr : node->as_array();
    if (pair == nullptr || pair->size() != 2)
      return fail(table, label, "needs alpha = [least, greatest], degrees", "give the interval of the twist");
    const double low = (*pair)[0].value_or<double>(NAN);
    const double high = (*pair)[1].value_or<double>(NAN);
    if (!(low < high))
      return fail(*node, label,
                  fmt::format("the interval alpha = [{:g}, {:g}] is inverted or empty", low, high),
                  "write the smaller angle first");
    if (low > 0.0 || high < 0.0 || low < -180.0 || high > 180.0)
      return fail(
          *node, label,
          fmt::format("the interval alpha = [{:g}, {:g}] must hold 0 and lie within -180 to 180", low, high),
          "measure alpha from the reference");
    range.twist_min = radians(low);
    range.twist_max = radians(high);
    return Done{};
  }

  Status read_meanings(const toml::table& table, const std::string& label, JointRange& range) const {
    constexpr std::array keys = {"meaning_a_y", "meaning_a_z", "meaning_alpha"};
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const toml::node* node = table.get(keys[i]);
      if (node == nullptr) continue;
      const std::string text = node->value_or<std::string>("");
      const auto slash = text.find("/-");
      if (!text.starts_with('+') || slash == std::string::npos)
        return fail(*node, label, fmt::format("{} is not \"+WORDS/-WORDS\"", keys[i]),
                    "say what an angle above 0 and one below 0 mean, as in \"+flexion/-extension\"");
      range.meanings[i] = {text.substr(1, slash - 1), text.substr(slash + 2)};
    }
    return Done{};
  }

  Result<RangeOfMotion> mirror_missing(const toml::table& table) {
    for (int j = 0; j < kJointCount; ++j) {
      if (given_[j]) continue;
      const Joint joint = joint_at(j);
      const Joint other = mirror_of(joint);
      if (other == joint || !given_[index(other)])
        return fail(table, std::string(name(joint)), "is missing",
                    "give the joint, its mirror, or base = \"human\"");
      range_.joints[j] = mirrored(range_.joints[index(other)]);
    }
    return range_;
  }

  std::string file_;
  int bases_;
  RangeOfMotion range_;
  PerJoint<bool> given_{};  // has a range: of the base, or read
  PerJoint<bool> read_{};   // has a table
};

}  // namespace

// Reflection in the sagittal plane, z -> -z: x and y axes are reflected, z = x cross y, so (a_y, a_z, alpha)
// of the mirrored pose is (-a_y, a_z, -alpha).
JointRange mirrored(const JointRange& range) {
  const auto reflect = [](Vec3 v) {
    v.z() = -v.z();
    return v;
  };
  const Mat3 axes = range.frame.parent_from_joint.toRotationMatrix();
  Mat3 other;
  other.col(0) = reflect(axes.col(0));
  other.col(1) = reflect(axes.col(1));
  other.col(2) = other.col(0).cross(other.col(1));
  const Quat& r = range.frame.reference;
  JointRange result;
  result.frame.parent_from_joint = Quat(other).normalized();
  result.frame.reference = Quat(r.w(), -r.x(), -r.y(), r.z());
  for (auto corner = range.polygon.rbegin(); corner != range.polygon.rend(); ++corner)
    result.polygon.emplace_back(-corner->x(), corner->y());
  result.twist_min = -range.twist_max;
  result.twist_max = -range.twist_min;
  const auto swapped = [](const AxisMeaning& meaning) {
    return AxisMeaning{meaning.negative, meaning.positive};
  };
  result.meanings = {swapped(range.meanings[0]), range.meanings[1], swapped(range.meanings[2])};
  return result;
}

Result<RangeOfMotion> with_joint_tables(RangeOfMotion range, const toml::array& joints,
                                        const std::string& file) {
  return RegionReader(file).change(std::move(range), joints);
}

namespace {

Result<RangeOfMotion> parse_region(std::string_view text, const std::string& file, int bases) {
  try {
    return RegionReader(file, bases).read(toml::parse(text, file));
  } catch (const toml::parse_error& error) {
    return error_at(error.source().begin,
                    input_error(file, std::string(error.description()), "correct the TOML"));
  }
}

Result<RangeOfMotion> load_region(const std::string& name_or_file, int bases) {
  const bool named = name_or_file == "human" || name_or_file == "diamond" || name_or_file == "box";
  std::filesystem::path path = name_or_file;
  if (named) {
    Result<std::filesystem::path> asset = find_asset("limits/" + name_or_file + ".toml");
    if (!asset) return asset.error();
    path = *asset;
  }
  Result<std::vector<std::uint8_t>> bytes = read_file(path, kMaxBytes);
  if (!bytes) {
    Error error = bytes.error();
    if (!named) error.fix = "name one of human, diamond, box, or a TOML file";
    return error;
  }
  Result<RangeOfMotion> range =
      parse_region({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path.string(), bases);
  if (range && named) range->name = name_or_file;
  return range;
}

}  // namespace

Result<RangeOfMotion> parse_range_of_motion(std::string_view text, const std::string& file) {
  return parse_region(text, file, 0);
}

Result<RangeOfMotion> load_range_of_motion(const std::string& name_or_file) {
  return load_region(name_or_file, 0);
}

}  // namespace ukemi
