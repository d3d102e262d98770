#include "body/muscles.h"

#include <toml++/toml.h>

#include <string>

#include "base/errors.h"
#include "base/files.h"

namespace ukemi {
namespace {

constexpr std::size_t kMaxBytes = 1u << 20;
constexpr double kMass_kg = 73.0;    // of the man in the table
constexpr double kHeight_m = 1.741;  // of the same

Error fail(const std::string& file, const toml::node& where, std::string joint, std::string what) {
  return error_at(
      where.source().begin,
      error_about(std::move(joint),
                  input_error(file, std::move(what),
                              "give x, y and z, each [least, most] in N m, least below and most above 0")));
}

/// "knee" for knee_l and knee_r.
std::string_view side_free(std::string_view joint) {
  return joint.ends_with("_l") || joint.ends_with("_r") ? joint.substr(0, joint.size() - 2) : joint;
}

/// The other side's: reflection in the sagittal plane turns x and y round.
JointStrength mirrored(const JointStrength& right) {
  JointStrength left = right;
  for (int axis = 0; axis < 2; ++axis) {
    left.least_n_m[axis] = -right.most_n_m[axis];
    left.most_n_m[axis] = -right.least_n_m[axis];
  }
  return left;
}

Result<JointStrength> read_joint(const toml::table& table, const std::string& joint,
                                 const std::string& file) {
  constexpr std::string_view kAxes[] = {"x", "y", "z"};
  JointStrength strength;
  for (int axis = 0; axis < 3; ++axis) {
    const toml::array* bounds = table[kAxes[axis]].as_array();
    if (bounds == nullptr || bounds->size() != 2) return fail(file, table, joint, "lacks an axis");
    strength.least_n_m[axis] = (*bounds)[0].value_or(0.0);
    strength.most_n_m[axis] = (*bounds)[1].value_or(0.0);
    if (!(strength.least_n_m[axis] < 0.0 && strength.most_n_m[axis] > 0.0))
      return fail(file, *bounds, joint, "has a bound on the wrong side of 0");
  }
  return strength;
}

Result<MuscleStrength> read(const toml::table& document, const std::string& file, double share, Sex sex) {
  const toml::table* table = document["strength"].as_table();
  if (table == nullptr) return fail(file, document, "", "has no [strength] table");
  share *= document["eccentric"].value_or(1.0);
  if (sex == Sex::female) share *= document["female"].value_or(1.0);
  MuscleStrength strength;
  for (int j = 0; j < kJointCount; ++j) {
    const std::string joint(side_free(name(joint_at(j))));
    const toml::table* values = (*table)[joint].as_table();
    if (values == nullptr) return fail(file, *table, joint, "has no strength");
    const auto right = read_joint(*values, joint, file);
    if (!right) return right.error();
    strength[j] = is_left(joint_at(j)) ? mirrored(*right) : *right;
    strength[j].least_n_m *= share;
    strength[j].most_n_m *= share;
  }
  return strength;
}

}  // namespace

Result<MuscleStrength> muscle_strength(const ArticulatedBody& body, Sex sex, double share) {
  const auto path = find_asset("muscles.toml");
  if (!path) return path.error();
  const auto bytes = read_file(*path, kMaxBytes);
  if (!bytes) return bytes.error();
  const double size = body.mass_kg * body.height_m / (kMass_kg * kHeight_m);
  try {
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    return read(toml::parse(text, path->string()), path->string(), share * size, sex);
  } catch (const toml::parse_error& error) {
    return error_at(error.source().begin,
                    input_error(*path, std::string(error.description()), "correct the TOML"));
  }
}

}  // namespace ukemi
