// The models of an FBX, which are its nodes, and how its objects hang together.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fbx/model_transform.h"
#include "fbx/tree.h"

namespace ukemi {

struct FbxModel {
  std::int64_t id = 0;
  std::string name;  // as in the file, without the class
  std::string type;  // "LimbNode", "Null", "Mesh", ...
  ModelTransform transform;
  std::vector<int> children;  // in order of the connections
};

/// Contract: the children form a forest; roots and children are indices into `models`.
struct FbxModels {
  std::vector<FbxModel> models;
  std::vector<int> roots;  // children of the scene
};

/// Models that are not connected to the scene are left out of `roots` and of every `children`.
FbxModels models_of(const FbxTree& tree);

/// Name of an object, without the class that follows it in the file.
std::string object_title(const FbxRecord& object);

/// The top-level record of that name; nullptr when there is none.
const FbxRecord* section(const FbxTree& tree, std::string_view name);
FbxRecord* section(FbxTree& tree, std::string_view name);

/// Hands out ids that are free in the tree. They are small, because some readers hold ids as doubles.
class FbxIds {
 public:
  explicit FbxIds(const FbxTree& tree);
  std::int64_t next();

 private:
  std::set<std::int64_t> taken_;
  std::int64_t last_ = 1'000'000;
};

/// Objects and connections that are to be added to a document.
struct FbxRecords {
  FbxIds& ids;
  std::vector<FbxRecord> objects;
  std::vector<FbxRecord> connections;
};

/// A name fit for a file: not empty, and without the characters that separate name and class.
std::string fbx_name(const std::string& name, const std::string& otherwise);

/// Name and class as binary files join them: "Hips\0\1Model".
std::string object_name(std::string_view name, std::string_view class_name);

/// "C: OO, child, parent": the object belongs to another; 0 is the scene.
FbxRecord connection(std::int64_t child, std::int64_t parent);
/// "C: OP, child, parent, property": the object drives a property.
FbxRecord connection(std::int64_t child, std::int64_t parent, std::string_view property);

/// A "P" record: name, type, label, flags, then values.
FbxRecord property_record(std::string_view name, std::string_view type, std::string_view label,
                          std::string_view flags, std::vector<FbxProperty> values);

/// Raises the number of objects of a class that the document states.
void count_definitions(FbxTree& tree, std::map<std::string, std::int32_t> added);

}  // namespace ukemi
