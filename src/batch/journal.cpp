#include "batch/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/descriptors.h"
#include "base/digest.h"
#include "base/errors.h"
#include "base/files.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxBytes = 4ull << 30;

/// Locks the file for this process; false where another has it. The workers of a batch that was killed hold
/// its lock for the moment that they outlive it.
bool locked(int fd) {
  constexpr int kTries = 100;
  constexpr useconds_t kPause_us = 20000;
  for (int i = 0; i < kTries; ++i) {
    if (flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    usleep(kPause_us);
  }
  return false;
}

Error cannot_write(const fs::path& path, const std::string& why) {
  return output_error(path, "cannot write: " + why,
                      "choose a folder that has space and that you may write to");
}

void take_verdict(std::string_view line, Verdicts& verdicts) {
  try {
    const Json json = Json::parse(line);
    const std::pair key(json.at("character").get<std::string>(), json.at("name").get<std::string>());
    if (json.value("accepted", false)) {
      verdicts.accepted.insert(key);
      return;
    }
    verdicts.accepted.erase(key);
    const int take = json.at("take");
    const bool left_out = json.at("left_out");
    const std::string comment = json.at("comment");
    verdicts.takes[key] = take;
    if (left_out)
      verdicts.left_out[key] = comment;
    else
      verdicts.left_out.erase(key);
  } catch (const Json::exception&) {  // a line that was cut off
  }
}

void take_line(std::string_view line, History& history) {
  if (auto record = parse_record(line))
    history.by_digest.insert_or_assign(record->digest, std::move(*record));
  else
    take_verdict(line, history.verdicts);
}

fs::path journal_folder(const fs::path& folder) { return folder / ".ukemi"; }

}  // namespace

History read_history(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(journal_folder(folder), error))
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  History history;
  for (const fs::path& file : files) {
    const auto bytes = read_file(file, kMaxBytes);
    if (!bytes) continue;
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size() - 1);
      take_line(text.substr(0, end + 1), history);
      text.remove_prefix(end + 1);
    }
  }
  return history;
}

bool is_intact(const ReactionRecord& record, const fs::path& folder) {
  return std::all_of(record.files.begin(), record.files.end(), [&](const WrittenFile& file) {
    std::error_code error;
    if (fs::file_size(folder / file.name, error) != file.bytes || error) return false;
    const auto bytes = read_file(folder / file.name, kMaxBytes);
    return bytes && digest_of(*bytes) == file.sha256;
  });
}

Result<Journal> Journal::open(const fs::path& folder, const std::string& name) {
  const fs::path path = journal_folder(folder) / (name + ".jsonl");
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return cannot_write(path.parent_path(), error.message());
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) return cannot_write(path, std::strerror(errno));
  Journal journal(path, fd);
  if (!locked(fd))
    return output_error(folder, "another batch is writing to this folder",
                        "wait until it has ended, or choose another folder");
  const off_t size = lseek(fd, 0, SEEK_END);
  char last = '\n';
  if (size > 0 && pread(fd, &last, 1, size - 1) == 1 && last != '\n')
    if (const Status status = journal.add_line(""); !status) return status.error();
  return journal;
}

Journal::~Journal() {
  if (fd_ >= 0) close(fd_);
}

Status Journal::add(const ReactionRecord& record) { return add_line(record_line(record)); }

Status Journal::add_verdict(const std::string& character, const std::string& name, int take, bool left_out,
                            const std::string& comment) {
  const Json json = {
      {"character", character}, {"name", name}, {"take", take}, {"left_out", left_out}, {"comment", comment}};
  return add_line(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Status Journal::add_accepted(const std::string& character, const std::string& name) {
  const Json json = {{"character", character}, {"name", name}, {"accepted", true}};
  return add_line(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Status Journal::add_line(std::string line) {
  line += '\n';
  if (!write_all(fd_, line)) return cannot_write(path_, std::strerror(errno));
  return Done{};
}

}  // namespace ukemi
