// The tree of a binary FBX: read, looked through, given a take and written; read again, it is the same.
#include "fbx/models.h"
#include "fbx/take.h"
#include "fbx/tree.h"
#include "fuzz/checks.h"

namespace {

using namespace ukemi;

/// Every value by every reader.
void look_at(const FbxRecord& record) {
  for (std::size_t i = 0; i < record.properties.size(); ++i) {
    static_cast<void>(text_at(record, i));
    static_cast<void>(number_at(record, i));
    static_cast<void>(numbers_at(record, i));
  }
  for (const FbxRecord& child : record.children) look_at(child);
}

void require_forest(const FbxModels& all) {
  std::vector<int> open = all.roots;
  std::size_t seen = 0;
  while (!open.empty()) {
    const int model = open.back();
    open.pop_back();
    fuzz::require(++seen <= all.models.size(), "no model hangs below itself");
    for (const int child : all.models[model].children) open.push_back(child);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto tree = read_fbx_tree({data, size}, "input.fbx");
  if (!tree) {
    fuzz::require_clear(tree.error());
    return 0;
  }
  const auto first = write_fbx_tree(*tree, "output.fbx");
  fuzz::require(static_cast<bool>(first), "what was read can be written");
  const auto again = read_fbx_tree(*first, "output.fbx");
  fuzz::require(static_cast<bool>(again), "what was written can be read");
  const auto second = write_fbx_tree(*again, "output.fbx");
  fuzz::require(second && *second == *first, "the bytes stay");
  for (const FbxRecord& record : tree->records) look_at(record);
  const FbxModels all = models_of(*tree);
  require_forest(all);
  if (all.models.empty()) return 0;
  add_take(*tree, {"take", {0, 1}, {{all.models[0].id, {}, {{{0, 1}, {0, 0}, {0, 0}}}, {}}}});
  const auto with_take = write_fbx_tree(*tree, "output.fbx");
  fuzz::require(with_take && read_fbx_tree(*with_take, "output.fbx"), "the take can be read");
  return 0;
}
