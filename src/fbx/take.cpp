#include "fbx/take.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace ukemi {
namespace {

constexpr const char* kAxes[] = {"d|X", "d|Y", "d|Z"};
// Linear, as Blender's exporter writes it; the second number is a default tangent weight.
constexpr std::int32_t kLinearKey = 0x6104;
constexpr float kDefaultWeight = 9.419963346924634e-30f;

std::string unique_stack_name(const FbxTree& tree, const std::string& wanted) {
  std::set<std::string> taken;
  if (const FbxRecord* objects = section(tree, "Objects"))
    for (const FbxRecord& object : objects->children)
      if (object.name == "AnimationStack")
        if (const auto name = text_at(object, 1)) taken.emplace(name->substr(0, name->find('\0')));
  if (!taken.contains(wanted)) return wanted;
  for (int i = 2;; ++i) {
    std::string name = wanted + '_' + std::to_string(i);
    if (!taken.contains(name)) return name;
  }
}

bool rests(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [&](double value) {
    return static_cast<float>(value) == static_cast<float>(values.front());
  });
}

FbxRecord curve_record(std::int64_t id, const std::vector<std::int64_t>& ticks,
                       const std::vector<double>& values) {
  std::vector<std::int64_t> times = ticks;
  std::vector<float> keys(values.begin(), values.end());
  if (rests(values) && times.size() > 2) {
    times = {ticks.front(), ticks.back()};
    keys.resize(2);
  }
  const auto count = static_cast<std::int32_t>(times.size());
  return fbx_branch("AnimationCurve", {fbx_long(id), fbx_text(object_name("", "AnimCurve")), fbx_text("")},
                    {fbx_leaf("Default", {fbx_double(values.front())}), fbx_leaf("KeyVer", {fbx_int(4008)}),
                     fbx_leaf("KeyTime", {fbx_array(times)}), fbx_leaf("KeyValueFloat", {fbx_array(keys)}),
                     fbx_leaf("KeyAttrFlags", {fbx_array(std::vector<std::int32_t>{kLinearKey})}),
                     fbx_leaf("KeyAttrDataFloat", {fbx_array(std::vector<float>{0, 0, kDefaultWeight, 0})}),
                     fbx_leaf("KeyAttrRefCount", {fbx_array(std::vector<std::int32_t>{count})})});
}

/// A curve node with a curve for each axis; nothing for what is not animated.
void add_curves(const FbxTake& take, std::int64_t layer, std::int64_t model, const char* name,
                const char* property, const std::array<std::vector<double>, 3>& values, FbxRecords& added) {
  if (values[0].empty()) return;
  const std::int64_t node = added.ids.next();
  std::vector<FbxRecord> defaults;
  for (int i = 0; i < 3; ++i)
    defaults.push_back(property_record(kAxes[i], "Number", "", "A", {fbx_double(values[i].front())}));
  added.objects.push_back(fbx_branch(
      "AnimationCurveNode", {fbx_long(node), fbx_text(object_name(name, "AnimCurveNode")), fbx_text("")},
      {fbx_branch("Properties70", {}, std::move(defaults))}));
  added.connections.push_back(connection(node, layer));
  added.connections.push_back(connection(node, model, property));
  for (int i = 0; i < 3; ++i) {
    const std::int64_t curve = added.ids.next();
    added.objects.push_back(curve_record(curve, take.ticks, values[i]));
    added.connections.push_back(connection(curve, node, kAxes[i]));
  }
}

FbxRecord stack_record(std::int64_t id, const std::string& name, const FbxTake& take) {
  std::vector<FbxRecord> properties;
  const auto add = [&](const char* property, std::int64_t ticks) {
    properties.push_back(property_record(property, "KTime", "Time", "", {fbx_long(ticks)}));
  };
  add("LocalStart", take.ticks.front());
  add("LocalStop", take.ticks.back());
  add("ReferenceStart", take.ticks.front());
  add("ReferenceStop", take.ticks.back());
  return fbx_branch("AnimationStack", {fbx_long(id), fbx_text(object_name(name, "AnimStack")), fbx_text("")},
                    {fbx_branch("Properties70", {}, std::move(properties))});
}

/// The list of takes, for readers that are older than animation stacks.
FbxRecord old_take_record(const std::string& name, const FbxTake& take) {
  const std::vector<FbxProperty> span{fbx_long(take.ticks.front()), fbx_long(take.ticks.back())};
  return fbx_branch("Take", {fbx_text(name)},
                    {fbx_leaf("FileName", {fbx_text(name + ".tak")}), fbx_leaf("LocalTime", span),
                     fbx_leaf("ReferenceTime", span)});
}

void append(std::vector<FbxRecord> records, FbxRecord* target) {
  if (target == nullptr) return;
  target->is_closed = true;
  std::move(records.begin(), records.end(), std::back_inserter(target->children));
}

}  // namespace

void add_take(FbxTree& tree, const FbxTake& take) {
  FbxIds ids(tree);
  FbxRecords added{ids, {}, {}};
  const std::string name = unique_stack_name(tree, take.name);
  const std::int64_t stack = ids.next();
  const std::int64_t layer = ids.next();
  added.objects.push_back(stack_record(stack, name, take));
  added.objects.push_back(fbx_branch(
      "AnimationLayer", {fbx_long(layer), fbx_text(object_name(name, "AnimLayer")), fbx_text("")}, {}));
  added.connections.push_back(connection(stack, 0));
  added.connections.push_back(connection(layer, stack));
  for (const ModelCurves& curves : take.models) {
    add_curves(take, layer, curves.model, "T", "Lcl Translation", curves.translation, added);
    add_curves(take, layer, curves.model, "R", "Lcl Rotation", curves.rotation_deg, added);
    add_curves(take, layer, curves.model, "S", "Lcl Scaling", curves.scaling, added);
  }
  std::map<std::string, std::int32_t> counts;
  for (const FbxRecord& object : added.objects) ++counts[object.name];
  count_definitions(tree, std::move(counts));
  append(std::move(added.objects), section(tree, "Objects"));
  append(std::move(added.connections), section(tree, "Connections"));
  append({old_take_record(name, take)}, section(tree, "Takes"));
}

}  // namespace ukemi
