// What a batch has finished, so that it can be resumed: lines that are only ever added.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "bake/record.h"
#include "base/result.h"

namespace ukemi {

/// What reviewers said of a reaction, by {character, name}.
struct Verdicts {
  std::map<std::pair<std::string, std::string>, int> takes;             // rejected ones
  std::map<std::pair<std::string, std::string>, std::string> left_out;  // and the comment
  std::set<std::pair<std::string, std::string>> accepted;
  bool empty() const { return takes.empty() && left_out.empty() && accepted.empty(); }
};

/// What the journals of a folder say.
struct History {
  std::map<std::string, ReactionRecord> by_digest;  // the last of each
  Verdicts verdicts;
  bool empty() const { return by_digest.empty() && verdicts.empty(); }
};

/// Reads FOLDER/.ukemi/*.jsonl; lines that were cut off are passed over. A folder without them has no
/// history.
History read_history(const std::filesystem::path& folder);

/// Whether every file that the record names lies in the folder as it was written.
bool is_intact(const ReactionRecord& record, const std::filesystem::path& folder);

/// FOLDER/.ukemi/NAME.jsonl, open for more. Each line is written at once, so that a process that is killed
/// loses at most the line it was writing.
class Journal {
 public:
  /// Errors: output (cannot be made; another batch is writing it).
  static Result<Journal> open(const std::filesystem::path& folder, const std::string& name);
  ~Journal();
  Journal(Journal&& other) noexcept : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}
  Journal& operator=(Journal&&) = delete;

  Status add(const ReactionRecord& record);
  /// How often the reaction was rejected, and whether it is left out for good.
  Status add_verdict(const std::string& character, const std::string& name, int take, bool left_out,
                     const std::string& comment);
  Status add_accepted(const std::string& character, const std::string& name);

 private:
  Journal(std::filesystem::path path, int fd) : path_(std::move(path)), fd_(fd) {}
  Status add_line(std::string line);

  std::filesystem::path path_;
  int fd_ = -1;
};

}  // namespace ukemi
