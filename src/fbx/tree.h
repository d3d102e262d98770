// The tree of records that a binary FBX is: read, edited and written back as it was.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace ukemi {

/// A value of a record as its bytes stand in the file. `type`: Y C I F D L (a number), S R (text, raw bytes),
/// f d l i b c (an array of numbers, perhaps deflated).
struct FbxProperty {
  char type = 'I';
  std::vector<std::uint8_t> bytes;  // what follows the type's letter
};

struct FbxRecord {
  std::string name;
  std::vector<FbxProperty> properties;
  std::vector<FbxRecord> children;
  bool is_closed = false;  // ends with an empty record, as those with children do
};

/// Contract: write_fbx_tree(read_fbx_tree(bytes)) gives the same bytes.
struct FbxTree {
  std::uint32_t version = 7400;  // 7400 is 7.4
  std::vector<FbxRecord> records;
  std::vector<std::uint8_t> tail;  // what follows the last record: file code, padding, version, end mark
  std::size_t end_alignment = 4;   // of the version in the tail, modulo 16: 4 by Autodesk's SDK, 0 by Blender
};

/// Errors: input (ASCII, older than 7.0, malformed: with the byte offset in `what`).
Result<FbxTree> read_fbx_tree(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

/// Errors: output, when an FBX before 7.5 would pass 4 GiB.
Result<std::vector<std::uint8_t>> write_fbx_tree(const FbxTree& tree, const std::filesystem::path& path);

// ---- reading

/// The first child of that name; nullptr when there is none.
const FbxRecord* child_of(const FbxRecord& record, std::string_view name);
FbxRecord* child_of(FbxRecord& record, std::string_view name);
/// Property `i`; nothing where the record has no such property or it is of another kind.
std::optional<std::string_view> text_at(const FbxRecord& record, std::size_t i);
std::optional<std::int64_t> integer_at(const FbxRecord& record, std::size_t i);
std::optional<double> number_at(const FbxRecord& record, std::size_t i);
/// The numbers of an array property, inflated; nothing where the property is no array, or malformed.
std::optional<std::vector<double>> numbers_at(const FbxRecord& record, std::size_t i);

// ---- making

FbxProperty fbx_text(std::string_view text);
FbxProperty fbx_bytes(std::span<const std::uint8_t> bytes);
FbxProperty fbx_int(std::int32_t value);
FbxProperty fbx_long(std::int64_t value);
FbxProperty fbx_double(double value);
/// Array properties, deflated where that is shorter.
FbxProperty fbx_array(const std::vector<double>& values);
FbxProperty fbx_array(const std::vector<float>& values);
FbxProperty fbx_array(const std::vector<std::int32_t>& values);
FbxProperty fbx_array(const std::vector<std::int64_t>& values);

/// A record without children.
FbxRecord fbx_leaf(std::string name, std::vector<FbxProperty> properties);
/// A record with children.
FbxRecord fbx_branch(std::string name, std::vector<FbxProperty> properties, std::vector<FbxRecord> children);

}  // namespace ukemi
