#include "batch/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bake/library.h"
#include "base/digest.h"
#include "base/errors.h"
#include "base/files.h"
#include "batch/batch_work.h"
#include "batch/inputs.h"
#include "batch/rejects.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kTrials = 8;

using Key = std::pair<std::string, std::string>;

Key key_of(const Recipe& recipe, const Reaction& reaction) {
  return {recipe.characters[reaction.character].name, reaction.name};
}

bool is_elsewhere(const Shard& shard, std::size_t i) {
  return i % static_cast<std::size_t>(shard.count) != static_cast<std::size_t>(shard.index - 1);
}

std::string shard_suffix(const Shard& shard) {
  return shard.whole() ? "" : fmt::format(".{}-of-{}", shard.index, shard.count);
}

/// The record of a reaction that is done and whose files lie in the folder.
const ReactionRecord* finished(const History& history, const std::string& digest, const fs::path& folder) {
  const auto record = history.by_digest.find(digest);
  if (record == history.by_digest.end() || !record->second.done()) return nullptr;
  return is_intact(record->second, folder) ? &record->second : nullptr;
}

std::string journal_digest(std::string_view program, const std::string& inputs) {
  Digest digest;
  digest.add_field(program);
  digest.add_field(inputs);
  return digest.hex();
}

Status take_digests(BatchPlan& plan, std::string_view program) {
  InputDigests digests(plan.recipe);
  plan.planned.assign(plan.reactions.size(), {});
  for (std::size_t i = 0; i < plan.reactions.size(); ++i) {
    auto digest = digests.of(plan.reactions[i]);
    if (!digest) return digest.error();
    plan.planned[i].journal_digest = journal_digest(program, *digest);
    plan.planned[i].digest = std::move(*digest);
  }
  return Done{};
}

Status expand(BatchPlan& plan, std::string_view program) {
  auto reactions = reactions_of(plan.recipe, plan.history.verdicts.takes);
  if (!reactions) return reactions.error();
  plan.reactions = std::move(*reactions);
  return take_digests(plan, program);
}

void decide(BatchPlan& plan, const BatchSettings& settings) {
  for (std::size_t i = 0; i < plan.reactions.size(); ++i) {
    PlannedReaction& planned = plan.planned[i];
    if (is_elsewhere(settings.shard, i))
      planned.plan = Plan::elsewhere;
    else if (plan.history.verdicts.left_out.contains(key_of(plan.recipe, plan.reactions[i])))
      planned.plan = Plan::left_out;
    else if (!settings.force && finished(plan.history, planned.journal_digest, settings.folder))
      planned.plan = Plan::keep;
  }
}

/// Takes over what other folders have of this batch.
Status merge_folder(const BatchPlan& plan, const BatchSettings& settings, const fs::path& from,
                    Journal& journal, std::map<std::string, ReactionRecord>& records) {
  const History history = read_history(from);
  for (const PlannedReaction& planned : plan.planned) {
    const auto known = history.by_digest.find(planned.journal_digest);
    if (known == history.by_digest.end() || records.contains(planned.journal_digest)) continue;
    const ReactionRecord& record = known->second;
    if (record.done() && !is_intact(record, from)) continue;
    std::error_code error;
    const bool same = fs::equivalent(from, settings.folder, error);
    for (const WrittenFile& file : record.files) {
      if (same) break;
      const auto bytes = read_file(from / file.name, file.bytes);
      if (!bytes) return bytes.error();
      if (const Status status = write_file(settings.folder / file.name, *bytes); !status) return status;
    }
    if (!same)
      if (const Status status = journal.add(record); !status) return status;
    if (record.done()) records.emplace(planned.journal_digest, record);
  }
  return Done{};
}

Status make_folders(const BatchPlan& plan, const fs::path& folder) {
  for (const RecipeCharacter& character : plan.recipe.characters) {
    std::error_code error;
    fs::create_directories(folder / character.name, error);
    if (error)
      return output_error(folder / character.name, "cannot make the folder: " + error.message(),
                          "choose another folder");
  }
  return Done{};
}

Status note_verdicts(const BatchPlan& plan, Journal& journal) {
  for (const auto& [key, take] : plan.news.takes) {
    const auto comment = plan.news.left_out.find(key);
    const bool left_out = comment != plan.news.left_out.end();
    if (const Status status =
            journal.add_verdict(key.first, key.second, take, left_out, left_out ? comment->second : "");
        !status)
      return status;
  }
  for (const auto& key : plan.news.accepted)
    if (const Status status = journal.add_accepted(key.first, key.second); !status) return status;
  return Done{};
}

/// What the batch has: records of this run and of earlier ones, by digest.
class Batch {
 public:
  Batch(const BatchPlan& plan, const BatchSettings& settings, Journal journal)
      : plan_(plan), settings_(settings), journal_(std::move(journal)) {
    for (const PlannedReaction& planned : plan.planned)
      if (planned.plan == Plan::keep)
        records_.emplace(planned.journal_digest, plan.history.by_digest.at(planned.journal_digest));
    result_.kept = records_.size();
  }

  Status merge() {
    for (const fs::path& from : settings_.merge)
      if (const Status status = merge_folder(plan_, settings_, from, journal_, records_); !status)
        return status;
    return Done{};
  }

  Status bake(const std::function<void(const BatchProgress&)>& progress,
              const std::function<bool()>& stopped) {
    std::vector<std::string> jobs;
    std::vector<std::size_t> reactions;
    for (std::size_t i = 0; i < plan_.reactions.size(); ++i) {
      if (plan_.planned[i].plan != Plan::bake) continue;
      jobs.push_back(batch_job(i, plan_.planned[i].journal_digest, true));
      reactions.push_back(i);
    }
    BatchProgress state;
    state.total = jobs.size();
    progress(state);
    const auto ended = [&](const JobEnd& end) {
      const ReactionRecord& record = take(reactions[end.job], end);
      ++(record.done() ? result_.baked : state.failed);
      ++state.finished;
      state.last = &record;
      progress(state);
    };
    const Work work = batch_work(plan_.recipe, plan_.reactions, settings_.folder, settings_.after);
    const Status status = run_jobs(jobs, settings_.workers, work, ended,
                                   [&] { return result_.cannot_write.has_value() || stopped(); });
    if (!status) return status;
    result_.stopped = state.finished < state.total;
    return Done{};
  }

  Result<BatchResult> finish() {
    for (std::size_t i = 0; i < plan_.reactions.size(); ++i)
      if (auto entry = entry_of(i)) result_.entries.push_back(std::move(*entry));
    Manifest manifest{&plan_.recipe, plan_.reactions.size() - plan_.count(Plan::elsewhere), result_.entries};
    const std::string suffix = shard_suffix(settings_.shard);
    const std::vector<LibraryEntry> library = library_of(result_.entries);
    for (const auto& [name, text] : {std::pair("manifest" + suffix + ".json", manifest_json(manifest)),
                                     std::pair("manifest" + suffix + ".csv", manifest_csv(manifest)),
                                     std::pair("library" + suffix + ".json", library_json(library)),
                                     std::pair("library" + suffix + ".csv", library_csv(library))})
      if (const Status status = write_file(settings_.folder / name, text); !status) {
        if (!result_.cannot_write) result_.cannot_write = status.error();
        break;
      }
    return std::move(result_);
  }

 private:
  const ReactionRecord& take(std::size_t i, const JobEnd& end) {
    auto parsed = end.failure.empty() ? parse_record(end.answer) : std::nullopt;
    ReactionRecord record;
    if (parsed) {
      record = std::move(*parsed);
    } else {
      std::tie(record.character, record.name) = key_of(plan_.recipe, plan_.reactions[i]);
      record.digest = plan_.planned[i].journal_digest;
      record.error = "the worker " + (end.failure.empty() ? "gave no answer" : end.failure) + ", twice";
      record.fix = "bake it alone to see more: ukemi bake";
    }
    if (record.cannot_write && !result_.cannot_write)
      result_.cannot_write = output_error({}, record.error, record.fix);
    if (!record.cannot_write)
      if (const Status status = journal_.add(record); !status && !result_.cannot_write)
        result_.cannot_write = status.error();
    return records_.insert_or_assign(record.digest, std::move(record)).first->second;
  }

  /// Rows of what was baked, with the verdicts.
  std::vector<LibraryEntry> library_of(const std::vector<ManifestEntry>& entries) const {
    std::vector<LibraryEntry> library;
    for (const ManifestEntry& entry : entries) {
      if (!entry.record || !entry.record->done()) continue;
      const bool accepted =
          plan_.history.verdicts.accepted.contains({entry.record->character, entry.record->name});
      const bool rejected = entry.status == ReactionStatus::rejected;
      library.push_back({entry.record->library, rejected ? "rejected" : accepted ? "accepted" : ""});
    }
    return library;
  }

  std::string rejection(const ReactionFigures& figures) const {
    if (settings_.max_excess_deg && figures.excess_max_deg > *settings_.max_excess_deg)
      return fmt::format("leaves the range of motion by {:.3f} degrees: over --max-excess {}",
                         figures.excess_max_deg, *settings_.max_excess_deg);
    if (settings_.reject_unsettled && !figures.rest_time_s)
      return fmt::format("has not come to rest after {:.2f} s: --reject-unsettled", figures.duration_s);
    return "";
  }

  /// Nothing for what belongs to another shard or was not reached.
  std::optional<ManifestEntry> entry_of(std::size_t i) const {
    const PlannedReaction& planned = plan_.planned[i];
    ManifestEntry entry{&plan_.reactions[i], ReactionStatus::failed, planned.digest, {}, {}};
    if (planned.plan == Plan::elsewhere) return std::nullopt;
    if (planned.plan == Plan::left_out) {
      entry.status = ReactionStatus::rejected;
      const std::string& comment =
          plan_.history.verdicts.left_out.at(key_of(plan_.recipe, plan_.reactions[i]));
      entry.error = comment.empty() ? "left out by a reviewer" : "left out by a reviewer: " + comment;
      return entry;
    }
    const auto record = records_.find(planned.journal_digest);
    if (record == records_.end()) {
      if (settings_.merge.empty()) return std::nullopt;
      entry.error = "is in none of the merged folders";
      return entry;
    }
    entry.record = record->second;
    entry.error = entry.record->done() ? rejection(*entry.record->figures) : entry.record->error;
    if (entry.record->done())
      entry.status = entry.error.empty() ? ReactionStatus::done : ReactionStatus::rejected;
    return entry;
  }

  const BatchPlan& plan_;
  const BatchSettings& settings_;
  Journal journal_;
  std::map<std::string, ReactionRecord> records_;
  BatchResult result_;
};

}  // namespace

std::size_t BatchPlan::count(Plan plan) const {
  return static_cast<std::size_t>(
      std::count_if(planned.begin(), planned.end(), [plan](const auto& p) { return p.plan == plan; }));
}

Result<BatchPlan> plan_batch(const BatchSettings& settings) {
  BatchPlan plan;
  auto recipe = load_recipe(settings.recipe);
  if (!recipe) return recipe.error();
  plan.recipe = std::move(*recipe);
  plan.history = read_history(settings.folder);
  const bool may_go_on = settings.resume || settings.force || !settings.merge.empty() ||
                         !settings.rejects.empty() || !settings.shard.whole();
  if (!plan.history.empty() && !may_go_on)
    return usage_error(
        settings.folder, "holds a batch already",
        "add --resume to bake what is missing or changed, --force to bake everything again, or "
        "choose another folder");
  if (const Status status = expand(plan, settings.program); !status) return status.error();
  if (!settings.rejects.empty()) {
    if (const Status status = take_rejects(settings.rejects, plan); !status) return status.error();
    if (const Status status = expand(plan, settings.program); !status) return status.error();
  }
  decide(plan, settings);
  return plan;
}

Result<double> estimate_seconds(const BatchPlan& plan, const BatchSettings& settings) {
  const double jobs = static_cast<double>(plan.count(Plan::bake));
  if (jobs == 0.0) return 0.0;
  double seconds = 0.0, known = 0.0;
  for (const auto& [digest, record] : plan.history.by_digest) {
    if (!record.done()) continue;
    seconds += record.seconds;
    known += 1.0;
  }
  std::vector<std::string> trials;
  std::set<std::size_t> characters;
  for (std::size_t i = 0; i < plan.reactions.size() && known == 0.0; ++i)
    if (plan.planned[i].plan == Plan::bake && trials.size() < kTrials &&
        characters.insert(plan.reactions[i].character).second)
      trials.push_back(batch_job(i, "", false));
  const auto ended = [&](const JobEnd& end) {
    const auto record = end.failure.empty() ? parse_record(end.answer) : std::nullopt;
    if (!record) return;
    seconds += record->seconds;
    known += 1.0;
  };
  const Work work = batch_work(plan.recipe, plan.reactions, settings.folder);
  if (const Status status = run_jobs(trials, settings.workers, work, ended, [] { return false; }); !status)
    return status.error();
  const double workers = std::min(static_cast<double>(settings.workers.workers), jobs);
  return known > 0.0 ? seconds / known * jobs / workers : 0.0;
}

Result<BatchResult> run_batch(const BatchPlan& plan, const BatchSettings& settings,
                              const std::function<void(const BatchProgress&)>& progress,
                              const std::function<bool()>& stopped) {
  if (const Status status = make_folders(plan, settings.folder); !status) return status.error();
  auto journal =
      Journal::open(settings.folder, fmt::format("{}-of-{}", settings.shard.index, settings.shard.count));
  if (!journal) return journal.error();
  if (const Status status = note_verdicts(plan, *journal); !status) return status.error();
  Batch batch(plan, settings, std::move(*journal));
  const Status status = settings.merge.empty() ? batch.bake(progress, stopped) : batch.merge();
  if (!status) return status.error();
  return batch.finish();
}

}  // namespace ukemi
