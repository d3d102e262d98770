#include "batch/batch_work.h"

#include <chrono>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "bake/library.h"
#include "bake/report.h"
#include "base/character_path.h"
#include "base/digest.h"
#include "base/files.h"
#include "load/load.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kCharactersKept = 2;

struct Loaded {
  std::string file;
  Character character;
  Diagnostics diagnostics;  // of loading
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class BatchWorker {
 public:
  BatchWorker(const Recipe& recipe, fs::path folder, AfterBake after)
      : recipe_(recipe), folder_(std::move(folder)), after_(std::move(after)) {}

  ReactionRecord run(const Reaction& reaction, const std::string& digest, bool write) {
    const auto start = std::chrono::steady_clock::now();
    ReactionRecord record;
    record.character = recipe_.characters[reaction.character].name;
    record.name = reaction.name;
    record.digest = digest;
    if (const Status status = bake_into(record, reaction, write); !status) {
      record.figures.reset();
      record.library.clear();
      record.files.clear();
      record.error = status.error().message();
      record.fix = status.error().fix;
      record.cannot_write = status.error().kind == ErrorKind::output;
    } else if (write && after_) {
      after_(record, reaction.settings);
    }
    record.seconds = seconds_since(start);
    return record;
  }

 private:
  /// The character, loaded unless it was one of the last.
  Result<const Loaded*> character_of(const Reaction& reaction) {
    const std::string& file = recipe_.characters[reaction.character].file;
    for (auto known = kept_.begin(); known != kept_.end(); ++known) {
      if (known->file != file) continue;
      kept_.splice(kept_.begin(), kept_, known);
      return &kept_.front();
    }
    const auto path = character_path(file);
    if (!path) return path.error();
    Loaded loaded{file, {}, {}};
    auto character = load_character(*path, LoadOptions{}, loaded.diagnostics);
    if (!character) return character.error();
    loaded.character = std::move(*character);
    while (kept_.size() >= kCharactersKept) kept_.pop_back();
    kept_.push_front(std::move(loaded));
    return &kept_.front();
  }

  BakeSettings with_folder(BakeSettings settings) const {
    for (fs::path& output : settings.outputs) output = folder_ / output;
    if (!settings.sheet.empty()) settings.sheet = folder_ / settings.sheet;
    if (!settings.report.empty()) settings.report = folder_ / settings.report;
    if (!settings.events.empty()) settings.events = folder_ / settings.events;
    return settings;
  }

  Status bake_into(ReactionRecord& record, const Reaction& reaction, bool write) {
    const RecipeCharacter& named = recipe_.characters[reaction.character];
    const BakeSettings settings = with_folder(reaction.settings);
    if (write)
      if (const Status status = check_settings(named.file, settings); !status) return status;
    const auto loaded = character_of(reaction);
    if (!loaded) return loaded.error();
    Diagnostics diagnostics = (*loaded)->diagnostics;
    auto baked = bake_loaded((*loaded)->character, settings, diagnostics);
    if (!baked) return baked.error();
    if (write)
      if (const Status status = write_files(*baked); !status) return status;
    for (const OutputFile& file : baked->files) note(record, file.path, file.bytes);
    if (!settings.report.empty()) {
      const std::string report =
          report_json(named.written, (*loaded)->character, reaction.settings, *baked, diagnostics);
      if (write)
        if (const Status status = write_file(settings.report, report); !status) return status;
      note(record, settings.report, {reinterpret_cast<const std::uint8_t*>(report.data()), report.size()});
    }
    for (const Warning& warning : diagnostics.warnings())
      record.warnings.push_back(warning.subject.empty() ? warning.what
                                                        : warning.subject + ": " + warning.what);
    record.figures = figures_of(*baked);
    record.library = library_row(record.character, reaction.settings, *baked);
    return Done{};
  }

  void note(ReactionRecord& record, const fs::path& path, std::span<const std::uint8_t> bytes) const {
    record.files.push_back({path.lexically_relative(folder_).string(), bytes.size(), digest_of(bytes)});
  }

  const Recipe& recipe_;
  fs::path folder_;
  AfterBake after_;
  std::list<Loaded> kept_;  // the last used first
};

}  // namespace

std::string batch_job(std::size_t reaction, const std::string& digest, bool write) {
  return nlohmann::ordered_json({{"reaction", reaction}, {"digest", digest}, {"write", write}}).dump();
}

Work batch_work(const Recipe& recipe, const std::vector<Reaction>& reactions, fs::path folder,
                AfterBake after) {
  const auto worker = std::make_shared<BatchWorker>(recipe, std::move(folder), std::move(after));
  return [worker, &reactions](const std::string& line) {
    const auto job = nlohmann::json::parse(line);
    const Reaction& reaction = reactions.at(job.at("reaction").get<std::size_t>());
    return record_line(worker->run(reaction, job.at("digest"), job.at("write")));
  };
}

}  // namespace ukemi
