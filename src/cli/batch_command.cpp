#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <string>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "base/files.h"
#include "batch/batch.h"
#include "batch/input_faults.h"
#include "batch/manifest.h"
#include "cli/batch_progress.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/stop_signals.h"
#include "review/review.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr int kMostWorkers = 1024;
constexpr int kMostShards = 100000;
constexpr double kMegabyte = 1 << 20;

struct BatchRequest {
  std::string recipe;
  BatchSettings settings;
  double memory_mb = 4096.0;
  bool dry_run = false;
  bool review = true;
  bool json = false;
  bool quiet = false;
};

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && parsed == end ? std::optional(value) : std::nullopt;
}

Status take_shard(const std::string& text, Shard& shard) {
  const auto slash = text.find('/');
  const int index = whole_number(std::string_view(text).substr(0, slash)).value_or(0);
  const int count =
      slash == text.npos ? 0 : whole_number(std::string_view(text).substr(slash + 1)).value_or(0);
  if (index < 1 || index > count || count > kMostShards)
    return usage_error(fmt::format("'{}' is not I/N", text),
                       "give the part and the number of parts: 1/4 to 4/4");
  shard = {index, count};
  return Done{};
}

int processors() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void declare(Options& options, BatchRequest& request) {
  BatchSettings& settings = request.settings;
  options.argument("RECIPE", request.recipe, "a .toml file: ukemi recipe prints a commented one");
  options.group("what is baked");
  options.path("-o,--output", settings.folder,
               "folder for manifest.json, manifest.csv and a folder of each character; made where missing",
               "DIR");
  options.flag("--resume", settings.resume,
               "keep what the folder has of this recipe; bake what is missing or has other inputs");
  options.flag("--force", settings.force, "bake everything again");
  options.flag("--dry-run", request.dry_run,
               "list what would be baked, how long it would take, and what is wrong with the characters");
  options.custom(
      "--shard", "I/N", [&settings](const std::string& text) { return take_shard(text, settings.shard); },
      "only part I of N; the parts may share a folder");
  options.paths("--merge", settings.merge, "take over what shards baked, from this folder; bakes nothing",
                "DIR");
  options.group("review");
  options.path("--rejects", settings.rejects,
               "verdicts saved from the review page: rejected variations are baked again with another seed, "
               "other rejected reactions left out");
  options.number("--max-excess", "DEG", settings.max_excess_deg, Range{0.0, 180.0},
                 "reject reactions that leave the range of motion farther (before projection); status 1");
  options.flag("--reject-unsettled", settings.reject_unsettled,
               "reject reactions that do not come to rest; status 1");
  options.group("workers");
  options.whole("-j,--jobs", "N", settings.workers.workers, 1, kMostWorkers, "worker processes",
                fmt::format("default: one for each processor, here {}", processors()));
  options.number("--job-timeout", "S", settings.workers.job_timeout_s, Range{0.1, 86400.0},
                 "most time for one reaction; one that takes longer is given up after a second try");
  options.number(
      "--job-memory", "MB", request.memory_mb, Range{256.0, 1048576.0},
      "most memory of a worker process; a reaction that needs more is given up after a second try");
  options.group("out");
  options.on_off(
      "review", true, [&request](bool on) { request.review = on; },
      "make the review page, index.html, once all is baked", "make none");
  options.flag("--json", request.json, "the manifest to stdout");
  options.flag("--quiet", request.quiet, "nothing to stdout, no progress");
}

Status check(const BatchRequest& request) {
  const BatchSettings& settings = request.settings;
  if (settings.folder.empty()) return usage_error("no output", "add -o FOLDER");
  if (request.json && request.quiet)
    return usage_error("--json and --quiet exclude each other", "give one of them");
  if (settings.resume && settings.force)
    return usage_error("--resume and --force exclude each other", "give one of them");
  if (!settings.merge.empty() && (settings.force || !settings.shard.whole()))
    return usage_error("--merge excludes --force and --shard", "give --merge alone");
  for (const fs::path& folder : settings.merge)
    if (std::error_code error; !fs::is_directory(folder, error))
      return input_error(folder, "there is no such folder", "name a folder that a batch has written");
  return Done{};
}

std::string duration_text(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", std::max(seconds, 1.0));
  if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

std::string_view plan_word(Plan plan) {
  switch (plan) {
    case Plan::keep:
      return "keep";
    case Plan::left_out:
      return "leave out";
    default:
      return "bake";
  }
}

/// Recipes from before bodies lived meant falls where they said nothing.
void note_living(const BatchPlan& plan) {
  const auto unsaid =
      std::count_if(plan.reactions.begin(), plan.reactions.end(), [](const Reaction& reaction) {
        return !reaction.settings.behaviour && reaction.settings.simulation.fixed_hz == 0.0;
      });
  if (unsaid == 0) return;
  std::fputs(
      fmt::format(
          "ukemi: note: {} reactions do not say their behaviour: they are alert and keep their feet where a "
          "person would; behaviour = \"limp\" bakes falls of a limp body\n",
          unsaid)
          .c_str(),
      stderr);
}

/// What would be done, and how long it would take.
Result<std::string> dry_run_text(const BatchPlan& plan, const BatchSettings& settings) {
  std::string text;
  for (std::size_t i = 0; i < plan.reactions.size(); ++i) {
    const Reaction& reaction = plan.reactions[i];
    if (plan.planned[i].plan == Plan::elsewhere) continue;
    text += fmt::format("{:<9} {}/{}: {} from {}, {}\n", plan_word(plan.planned[i].plan),
                        plan.recipe.characters[reaction.character].name, reaction.name,
                        name(reaction.settings.hit), reaction.settings.from.text, reaction.settings.preset);
  }
  const auto seconds = estimate_seconds(plan, settings);
  if (!seconds) return seconds.error();
  text += fmt::format("{} to bake, {} to keep, {} left out", plan.count(Plan::bake), plan.count(Plan::keep),
                      plan.count(Plan::left_out));
  if (plan.count(Plan::bake) > 0)
    text += fmt::format("; about {} with {} worker{}", duration_text(*seconds), settings.workers.workers,
                        settings.workers.workers == 1 ? "" : "s");
  return text + "\n";
}

void print_fault(const InputFault& fault) {
  Error error = fault.error;
  error.what += fmt::format(" (stops {} reaction{} of '{}')", fault.reactions,
                            fault.reactions == 1 ? "" : "s", fault.character);
  print_error(error);
}

std::size_t count(const BatchResult& result, ReactionStatus status) {
  std::size_t sum = 0;
  for (const ManifestEntry& entry : result.entries) sum += entry.status == status ? 1 : 0;
  return sum;
}

std::string summary(const BatchRequest& request, const BatchPlan& plan, const BatchResult& result) {
  std::string text =
      fmt::format("{}: {} done", request.settings.folder.string(), count(result, ReactionStatus::done));
  if (result.kept > 0) text += fmt::format(" ({} from before)", result.kept);
  text += fmt::format(", {} rejected, {} failed\n", count(result, ReactionStatus::rejected),
                      count(result, ReactionStatus::failed));
  std::map<std::pair<std::size_t, std::string>, std::size_t> alike;  // of a character and an error
  for (const ManifestEntry& entry : result.entries)
    if (entry.status == ReactionStatus::failed) ++alike[{entry.reaction->character, entry.error}];
  for (const ManifestEntry& entry : result.entries) {
    if (entry.status == ReactionStatus::done) continue;
    std::size_t more = 0;
    if (entry.status == ReactionStatus::failed) {
      const std::size_t left = std::exchange(alike[{entry.reaction->character, entry.error}], 0);
      if (left == 0) continue;
      more = left - 1;
    }
    text += fmt::format("{} {}/{}{}: {}\n", name(entry.status),
                        plan.recipe.characters[entry.reaction->character].name, entry.reaction->name,
                        more > 0 ? fmt::format(" and {} more of this character", more) : "", entry.error);
  }
  return text;
}

/// Says why the batch ended early, and how to go on.
int report_stop(const BatchRequest& request, const BatchResult& result) {
  const std::string resume =
      fmt::format("ukemi batch {} -o {} --resume", request.recipe, request.settings.folder.string());
  if (result.cannot_write) {
    Error error = *result.cannot_write;
    error.fix = fmt::format("{}; what is finished is kept, to go on: {}", error.fix, resume);
    return print_error(error);
  }
  std::fputs(fmt::format("ukemi: stopped; {} finished reactions are kept, to go on: {}\n",
                         result.baked + result.kept, resume)
                 .c_str(),
             stderr);
  return 128 + StopSignals::stopped_by();
}

/// The page over what was baked, where it is not there yet; a shard has none.
Status make_page(const BatchRequest& request, const BatchResult& result) {
  const bool has_any = std::any_of(result.entries.begin(), result.entries.end(),
                                   [](const auto& entry) { return entry.record && entry.record->done(); });
  if (!request.review || !request.settings.shard.whole() || !has_any) return Done{};
  if (review_is_current(request.settings.folder)) return Done{};
  Diagnostics diagnostics;
  const auto review = write_review(request.settings.folder, {request.settings.workers.workers}, diagnostics);
  if (!request.quiet) print_warnings(diagnostics);
  return review ? Status(Done{}) : Status(review.error());
}

/// What the page needs of each reaction is made where it was baked. A failure is reported when the page is
/// made.
AfterBake parts_for_page(const BatchRequest& request) {
  const BatchSettings& settings = request.settings;
  if (!request.review || !settings.shard.whole() || !settings.merge.empty()) return {};
  return [folder = settings.folder](const ReactionRecord& record, const BakeSettings& baked) {
    ReviewPart part{record.character, record.name, {}, baked.report};
    for (const fs::path& output : baked.outputs) part.outputs.push_back(output.generic_string());
    static_cast<void>(make_review_part(folder, part));
  };
}

int run_planned(const BatchRequest& request, const BatchPlan& plan) {
  const StopSignals signals;
  auto result = [&] {
    BatchProgressView view(request.quiet);
    return run_batch(
        plan, request.settings, [&view](const BatchProgress& progress) { view.show(progress); },
        [&view] {
          view.tick();
          return StopSignals::stopped_by() != 0;
        });
  }();
  if (!result) return print_error(result.error());
  if (!request.quiet) note_living(plan);
  if (result->stopped || result->cannot_write) return report_stop(request, *result);
  if (const Status status = make_page(request, *result); !status) return print_error(status.error());
  const bool all_well = count(*result, ReactionStatus::done) == result->entries.size();
  const int status = all_well ? 0 : 1;
  if (request.quiet) return status;
  const Manifest manifest{&plan.recipe, result->entries.size(), result->entries};
  return request.json ? print_json(manifest_json(manifest), status)
                      : print_result(summary(request, plan, *result), status);
}

}  // namespace

int batch_command(const Arguments& arguments) {
  BatchRequest request;
  request.settings.workers.workers = processors();
  Options options("batch", "bakes every reaction of a recipe, in as many processes as there are processors");
  declare(options, request);
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (const Status status = check(request); !status) return print_error(status.error());
  request.settings.recipe = request.recipe;
  request.settings.after = parts_for_page(request);
  request.settings.workers.memory_bytes = static_cast<std::size_t>(request.memory_mb * kMegabyte);
  const auto plan = plan_batch(request.settings);
  if (!plan) return print_error(plan.error());
  if (!request.dry_run) return run_planned(request, *plan);
  const auto text = dry_run_text(*plan, request.settings);
  if (!text) return print_error(text.error());
  const std::vector<InputFault> faults = input_faults(*plan);
  for (const InputFault& fault : faults) print_fault(fault);
  return print_result(*text, faults.empty() ? 0 : 1);
}

}  // namespace ukemi
