#include "batch/rejects.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxBytes = 64u << 20;

using Json = nlohmann::json;

Error refused(const fs::path& file, std::string what) {
  return input_error(file, std::move(what), "give the file that the review page saves for this batch");
}

using Key = std::pair<std::string, std::string>;  // character, reaction
using Indices = std::map<Key, std::size_t>;       // of the plan's reactions

Indices indices_of(const BatchPlan& plan) {
  Indices indices;
  for (std::size_t i = 0; i < plan.reactions.size(); ++i)
    indices[{plan.recipe.characters[plan.reactions[i].character].name, plan.reactions[i].name}] = i;
  return indices;
}

/// The reaction that an entry names.
Result<Indices::const_iterator> reaction_named(const fs::path& file, const Json& entry,
                                               const Indices& indices) {
  const Key key(entry.at("character").get<std::string>(), entry.at("name").get<std::string>());
  const auto found = indices.find(key);
  if (found != indices.end()) return found;
  return refused(file, fmt::format("the recipe has no reaction '{}' of '{}'", key.second, key.first));
}

Status reject(const fs::path& file, const Json& entry, const Indices& indices, BatchPlan& plan) {
  const auto named = reaction_named(file, entry, indices);
  if (!named) return named.error();
  const auto& [key, i] = **named;
  if (entry.contains("digest") && entry["digest"] != plan.planned[i].digest) return Done{};
  Verdicts& known = plan.history.verdicts;
  const bool varies = plan.reactions[i].varies;
  const int take = known.takes[key] + (varies ? 1 : 0);
  known.takes[key] = plan.news.takes[key] = take;
  known.accepted.erase(key);
  if (varies) return Done{};
  known.left_out[key] = plan.news.left_out[key] = entry.value("comment", "");
  return Done{};
}

Status accept(const fs::path& file, const Json& entry, const Indices& indices, BatchPlan& plan) {
  const auto named = reaction_named(file, entry, indices);
  if (!named) return named.error();
  const Key& key = (*named)->first;
  plan.history.verdicts.accepted.insert(key);
  plan.news.accepted.insert(key);
  if (plan.history.verdicts.left_out.erase(key) == 0) return Done{};
  plan.news.takes[key] = plan.history.verdicts.takes[key];
  return Done{};
}

}  // namespace

Status take_rejects(const fs::path& file, BatchPlan& plan) {
  const auto bytes = read_file(file, kMaxBytes);
  if (!bytes) return bytes.error();
  try {
    const Json json = Json::parse(bytes->begin(), bytes->end());
    if (json.at("format") != 1) return refused(file, "has a format that this program does not know");
    const Indices indices = indices_of(plan);
    for (const Json& entry : json.value("rejects", Json::array()))
      if (const Status status = reject(file, entry, indices, plan); !status) return status;
    for (const Json& entry : json.value("accepts", Json::array()))
      if (const Status status = accept(file, entry, indices, plan); !status) return status;
  } catch (const Json::exception& exception) {
    return refused(file, fmt::format("is not a list of verdicts: {}", exception.what()));
  }
  return Done{};
}

}  // namespace ukemi
