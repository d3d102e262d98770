// What a simulated reaction costs: one table over random hits, everything interleaved in one process so that
// ratios hold on a busy machine. Times are the thread's CPU time.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>
#include <iostream>
#include <optional>
#include <string>

#include "base/character_path.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/numbers.h"
#include "bullet_peer.h"
#include "load/load.h"
#include "measure.h"
#include "other_build.h"
#include "stages.h"
#include "table.h"

namespace ukemi {
namespace {

constexpr const char* kUsage =
    "usage: ukemi_bench [CHARACTER [HITS]] [--seconds S] [--json FILE] [--against PROGRAM | --compare FILE]\n"
    "                   [--stages]\n";

struct Request {
  std::string character = "mannequin";
  int hits = 60;
  double duration_s = 3.0;
  std::string json, against, compare;
  bool stages = false, help = false;
};

/// Takes the next of the words as the value of the option before it.
Result<std::string> value_of(const std::string& option, int& i, int count, char** words) {
  if (i + 1 < count) return std::string(words[++i]);
  return usage_error(fmt::format("{} has no value", option), kUsage);
}

Status take_number(const std::string& text, const Range& range, double& target) {
  const auto number = parse_number(text, range);
  if (!number) return number.error();
  target = *number;
  return Done{};
}

Status take_argument(const std::string& word, int nth, Request& request) {
  if (nth == 0) {
    request.character = word;
    return Done{};
  }
  if (nth > 1) return usage_error(fmt::format("'{}' is one argument too many", word), kUsage);
  double hits = 0.0;
  if (const Status status = take_number(word, {1.0, 1e5}, hits); !status) return status;
  request.hits = static_cast<int>(hits);
  return Done{};
}

Status take_option(const std::string& word, int& i, int count, char** words, Request& request) {
  if (word == "--stages" || word == "--help" || word == "-h") {
    (word == "--stages" ? request.stages : request.help) = true;
    return Done{};
  }
  std::string* target = word == "--json"      ? &request.json
                        : word == "--against" ? &request.against
                        : word == "--compare" ? &request.compare
                                              : nullptr;
  if (target == nullptr && word != "--seconds")
    return usage_error(fmt::format("unknown option '{}'", word), kUsage);
  const auto value = value_of(word, i, count, words);
  if (!value) return value.error();
  if (target == nullptr) return take_number(*value, {0.1, 60.0}, request.duration_s);
  *target = *value;
  return Done{};
}

Result<Request> request_of(int count, char** words) {
  Request request;
  int nth = 0;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const Status status = word.starts_with("-") ? take_option(word, i, count, words, request)
                                                : take_argument(word, nth++, request);
    if (!status) return status.error();
  }
  return request;
}

Result<Character> loaded(const std::string& name) {
  Diagnostics diagnostics;
  const auto path = character_path(name);
  if (!path) return path.error();
  return load_character(*path, LoadOptions{}, diagnostics);
}

/// Another build asks: "HIT RUN" a line, a sample as JSON for each.
Status serve(const std::string& name, const std::string& hits, const std::string& seconds) {
  Request request;
  if (const Status status = take_argument(hits, 1, request); !status) return status;
  if (const Status status = take_number(seconds, {0.1, 60.0}, request.duration_s); !status) return status;
  const auto character = loaded(name);
  if (!character) return character.error();
  const auto measure = Measure::make(*character, request.hits, request.duration_s);
  if (!measure) return measure.error();
  std::cout << kServe << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    const auto space = line.find(' ');
    const auto hit = number_in(line.substr(0, space));
    if (!hit || *hit < 0 || *hit >= measure->hits() || space == line.npos) return Done{};
    const nlohmann::json answer = measure->sample(static_cast<int>(*hit), line.substr(space + 1));
    std::cout << answer.dump() << std::endl;
  }
  return Done{};
}

/// All runs of all hits; the other build's beside ours, each first in turn.
Status measure_all(const Measure& measure, OtherBuild* other, std::vector<Sample>& ours,
                   std::vector<Sample>& theirs) {
  for (int hit = 0; hit < measure.hits(); ++hit)
    for (const std::string& run : Measure::runs()) {
      const bool asks = other != nullptr && run != kBulletRun;
      const bool asks_first = asks && ours.size() % 2 == 0;
      for (const bool first : {true, false}) {
        if (!asks || asks_first != first) {
          if (asks || first) ours.push_back(measure.sample(hit, run));
          continue;
        }
        auto sample = other->sample(hit, run);
        if (!sample) return sample.error();
        theirs.push_back(*sample);
      }
    }
  return Done{};
}

/// What an earlier run wrote, where it is to be compared with.
Result<std::optional<Measured>> earlier(const Request& request) {
  if (request.compare.empty()) return std::optional<Measured>();
  auto old = measured_in(request.compare);
  if (!old) return old.error();
  if (old->character != request.character || old->duration_s != request.duration_s)
    return usage_error(fmt::format("'{}' is of {}, {:g} s a hit, not of {}, {:g} s", request.compare,
                                   old->character, old->duration_s, request.character, request.duration_s),
                       "measure both alike");
  return std::optional<Measured>(std::move(*old));
}

void print_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("peak memory {:.0f} MB\n", static_cast<double>(usage.ru_maxrss) / 1024.0);
}

Status run(const Request& request) {
  const auto old = earlier(request);
  if (!old) return old.error();
  const auto character = loaded(request.character);
  if (!character) return character.error();
  const auto measure = Measure::make(*character, request.hits, request.duration_s);
  if (!measure) return measure.error();
  std::optional<OtherBuild> other;
  if (!request.against.empty()) {
    auto started = OtherBuild::start(request.against, request.character, request.hits, request.duration_s);
    if (!started) return started.error();
    other.emplace(std::move(*started));
  }
  Measured measured{request.character, request.hits, request.duration_s, {}};
  std::vector<Sample> theirs;
  if (const Status status = measure_all(*measure, other ? &*other : nullptr, measured.samples, theirs);
      !status)
    return status;
  fmt::print("{}", table_text(measured));
  if (!has_bullet()) fmt::print("Bullet is left out: libbullet-dev was not there when this was configured\n");
  if (other) fmt::print("{}", comparison_text(measured.samples, theirs, false));
  if (*old) fmt::print("{}", comparison_text(measured.samples, (*old)->samples, true));
  if (request.stages)
    if (const Status status = measure_stages(*character, request.hits); !status) return status;
  print_memory();
  return request.json.empty() ? Status(Done{}) : write_file(request.json, table_json(measured));
}

Status begin(int count, char** words) {
  if (count == 5 && std::string(words[1]) == kServe) return serve(words[2], words[3], words[4]);
  const auto request = request_of(count, words);
  if (!request) return request.error();
  if (!request->help) return run(*request);
  fmt::print("{}", kUsage);
  return Done{};
}

}  // namespace
}  // namespace ukemi

int main(int count, char** words) {
  const ukemi::Status status = ukemi::begin(count, words);
  if (status) return 0;
  fmt::print(stderr, "ukemi_bench: {}\n", status.error().message());
  if (!status.error().fix.empty()) fmt::print(stderr, "{}\n", status.error().fix);
  return ukemi::exit_status(status.error().kind);
}
