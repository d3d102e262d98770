#include "fbx/models.h"

#include <cmath>
#include <map>
#include <utility>

namespace ukemi {
namespace {

constexpr std::string_view kClassMark{"\0\1", 2};

/// Overwrites properties with the values of "P" records.
void read_properties(const FbxRecord* properties, ModelTransform& transform) {
  if (properties == nullptr) return;
  const std::pair<std::string_view, Vec3*> vectors[] = {{"Lcl Translation", &transform.translation},
                                                        {"Lcl Rotation", &transform.rotation_deg},
                                                        {"Lcl Scaling", &transform.scaling},
                                                        {"RotationOffset", &transform.rotation_offset},
                                                        {"RotationPivot", &transform.rotation_pivot},
                                                        {"PreRotation", &transform.pre_rotation_deg},
                                                        {"PostRotation", &transform.post_rotation_deg},
                                                        {"ScalingOffset", &transform.scaling_offset},
                                                        {"ScalingPivot", &transform.scaling_pivot}};
  for (const FbxRecord& record : properties->children) {
    const auto name = text_at(record, 0);
    if (!name) continue;
    if (*name == "RotationOrder")
      transform.rotation_order = static_cast<int>(integer_at(record, 4).value_or(0));
    for (const auto& [known, vector] : vectors)
      if (*name == known)
        for (int i = 0; i < 3; ++i) {
          const auto number = number_at(record, 4 + static_cast<std::size_t>(i));
          if (number && std::isfinite(*number)) (*vector)[i] = *number;
        }
  }
}

/// Properties of models that do not state their own.
ModelTransform template_of_models(const FbxTree& tree) {
  ModelTransform transform;
  const FbxRecord* definitions = section(tree, "Definitions");
  if (definitions == nullptr) return transform;
  for (const FbxRecord& type : definitions->children) {
    if (type.name != "ObjectType" || text_at(type, 0) != "Model") continue;
    const FbxRecord* properties = child_of(type, "PropertyTemplate");
    if (properties != nullptr) read_properties(child_of(*properties, "Properties70"), transform);
  }
  return transform;
}

/// Gives every model its first parent that is not one of its descendants.
void connect(const FbxTree& tree, FbxModels& all) {
  const FbxRecord* connections = section(tree, "Connections");
  if (connections == nullptr) return;
  std::map<std::int64_t, int> model_of;
  for (std::size_t i = 0; i < all.models.size(); ++i) model_of.emplace(all.models[i].id, static_cast<int>(i));
  constexpr int kNone = -2;
  std::vector<int> parent(all.models.size(), kNone);
  const auto is_below = [&](int node, int other) {
    for (; node >= 0; node = parent[node])
      if (node == other) return true;
    return false;
  };
  for (const FbxRecord& record : connections->children) {
    const auto child = model_of.find(integer_at(record, 1).value_or(0));
    const std::int64_t above = integer_at(record, 2).value_or(-1);
    const auto found = model_of.find(above);
    if (text_at(record, 0) != "OO" || child == model_of.end() || parent[child->second] != kNone) continue;
    if (above == 0) {
      parent[child->second] = -1;
      all.roots.push_back(child->second);
    } else if (found != model_of.end() && !is_below(found->second, child->second)) {
      parent[child->second] = found->second;
      all.models[found->second].children.push_back(child->second);
    }
  }
}

}  // namespace

const FbxRecord* section(const FbxTree& tree, std::string_view name) {
  for (const FbxRecord& record : tree.records)
    if (record.name == name) return &record;
  return nullptr;
}
FbxRecord* section(FbxTree& tree, std::string_view name) {
  return const_cast<FbxRecord*>(section(std::as_const(tree), name));
}

std::string object_title(const FbxRecord& object) {
  const std::string_view name = text_at(object, 1).value_or("");
  return std::string(name.substr(0, name.find(kClassMark)));
}

FbxModels models_of(const FbxTree& tree) {
  FbxModels all;
  const FbxRecord* objects = section(tree, "Objects");
  if (objects == nullptr) return all;
  const ModelTransform defaults = template_of_models(tree);
  for (const FbxRecord& object : objects->children) {
    const auto id = integer_at(object, 0);
    if (object.name != "Model" || !id) continue;
    FbxModel model{*id, object_title(object), std::string(text_at(object, 2).value_or("")), defaults, {}};
    read_properties(child_of(object, "Properties70"), model.transform);
    all.models.push_back(std::move(model));
  }
  connect(tree, all);
  return all;
}

FbxIds::FbxIds(const FbxTree& tree) {
  for (const char* name : {"Objects", "Documents"})
    if (const FbxRecord* records = section(tree, name))
      for (const FbxRecord& record : records->children)
        if (const auto id = integer_at(record, 0)) taken_.insert(*id);
}

std::int64_t FbxIds::next() {
  do ++last_;
  while (!taken_.insert(last_).second);
  return last_;
}

std::string fbx_name(const std::string& name, const std::string& otherwise) {
  std::string clean;
  for (const char c : name)
    if (c != '\0' && c != '\1') clean.push_back(c);
  return clean.empty() ? otherwise : clean;
}

std::string object_name(std::string_view name, std::string_view class_name) {
  std::string joined(name);
  joined.append(kClassMark);
  joined.append(class_name);
  return joined;
}

FbxRecord connection(std::int64_t child, std::int64_t parent) {
  return fbx_leaf("C", {fbx_text("OO"), fbx_long(child), fbx_long(parent)});
}
FbxRecord connection(std::int64_t child, std::int64_t parent, std::string_view property) {
  return fbx_leaf("C", {fbx_text("OP"), fbx_long(child), fbx_long(parent), fbx_text(property)});
}

FbxRecord property_record(std::string_view name, std::string_view type, std::string_view label,
                          std::string_view flags, std::vector<FbxProperty> values) {
  FbxRecord record = fbx_leaf("P", {fbx_text(name), fbx_text(type), fbx_text(label), fbx_text(flags)});
  for (FbxProperty& value : values) record.properties.push_back(std::move(value));
  return record;
}

void count_definitions(FbxTree& tree, std::map<std::string, std::int32_t> added) {
  FbxRecord* definitions = section(tree, "Definitions");
  if (definitions == nullptr) return;
  std::int32_t total = 0;
  const auto add_to = [](FbxRecord& record, std::int32_t count) {
    if (FbxRecord* said = child_of(record, "Count"))
      said->properties = {fbx_int(static_cast<std::int32_t>(integer_at(*said, 0).value_or(0)) + count)};
  };
  for (const auto& [name, count] : added) total += count;
  for (FbxRecord& type : definitions->children) {
    const auto found = added.find(std::string(text_at(type, 0).value_or("")));
    if (type.name != "ObjectType" || found == added.end()) continue;
    add_to(type, found->second);
    added.erase(found);
  }
  for (const auto& [name, count] : added)
    definitions->children.push_back(
        fbx_branch("ObjectType", {fbx_text(name)}, {fbx_leaf("Count", {fbx_int(count)})}));
  add_to(*definitions, total);
}

}  // namespace ukemi
