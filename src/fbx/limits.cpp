#include "fbx/limits.h"

#include <algorithm>
#include <array>
#include <map>

#include "fbx/models.h"

namespace ukemi {
namespace {

constexpr double kLeaves = 1e-3;  // degrees or file units

Vec3 vector_of(const FbxRecord& properties, const std::string& name, const Vec3& otherwise) {
  for (const FbxRecord& record : properties.children)
    if (text_at(record, 0) == name)
      return {number_at(record, 4).value_or(0), number_at(record, 5).value_or(0),
              number_at(record, 6).value_or(0)};
  return otherwise;
}

/// Switches a limit off where it is on and the curve exceeds it; true when it did.
bool lift(FbxRecord& properties, const std::string& name, bool leaves) {
  for (FbxRecord& record : properties.children) {
    if (text_at(record, 0) != name || record.properties.size() < 5) continue;
    if (!leaves || integer_at(record, 4).value_or(0) == 0) return false;
    std::fill(record.properties[4].bytes.begin(), record.properties[4].bytes.end(), std::uint8_t{0});
    return true;
  }
  return false;
}

/// All limits of one quantity: "Rotation" or "Translation", as the names of the properties begin.
bool lift_limits_of(FbxRecord& properties, const std::string& quantity,
                    const std::array<std::vector<double>, 3>& curves) {
  if (curves[0].empty()) return false;
  const Vec3 least = vector_of(properties, quantity + "Min", Vec3::Zero());
  const Vec3 most = vector_of(properties, quantity + "Max", Vec3::Zero());
  bool lifted = false;
  for (int i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax_element(curves[i].begin(), curves[i].end());
    const std::string axis(1, "XYZ"[i]);
    lifted |= lift(properties, quantity + "Min" + axis, *low < least[i] - kLeaves);
    lifted |= lift(properties, quantity + "Max" + axis, *high > most[i] + kLeaves);
  }
  return lifted;
}

}  // namespace

std::vector<std::string> lift_limits(FbxTree& tree, const FbxTake& take) {
  std::vector<std::string> names;
  FbxRecord* objects = section(tree, "Objects");
  if (objects == nullptr) return names;
  std::map<std::int64_t, FbxRecord*> models;
  for (FbxRecord& object : objects->children)
    if (object.name == "Model") models.emplace(integer_at(object, 0).value_or(0), &object);
  for (const ModelCurves& curves : take.models) {
    const auto found = models.find(curves.model);
    FbxRecord* properties = found == models.end() ? nullptr : child_of(*found->second, "Properties70");
    if (properties == nullptr) continue;
    const bool turns = lift_limits_of(*properties, "Rotation", curves.rotation_deg);
    const bool moves = lift_limits_of(*properties, "Translation", curves.translation);
    if (turns || moves) names.emplace_back(object_title(*found->second));
  }
  return names;
}

}  // namespace ukemi
