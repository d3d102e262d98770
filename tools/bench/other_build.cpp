#include "other_build.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

#include "base/errors.h"
#include "base/process.h"

namespace ukemi {
namespace {

std::string line_of(std::FILE* stream) {
  std::string line;
  for (int c = std::getc(stream); c != EOF && c != '\n'; c = std::getc(stream)) line += static_cast<char>(c);
  return line;
}

}  // namespace

Result<OtherBuild> OtherBuild::start(const std::string& program, const std::string& character, int hits,
                                     double duration_s) {
  signal(SIGPIPE, SIG_IGN);
  auto question = make_pipe();
  auto answer = make_pipe();
  if (!question || !answer) return internal_error("cannot make a pipe", "close other programs and try again");
  OtherBuild other;
  other.program_ = program;
  const pid_t parent = getpid();
  other.pid_ = fork();
  if (other.pid_ < 0) return internal_error("cannot make a process", "close other programs and try again");
  if (other.pid_ == 0) {
    die_with(parent);
    dup2(question->read.get(), STDIN_FILENO);
    dup2(answer->write.get(), STDOUT_FILENO);
    execl(program.c_str(), program.c_str(), kServe, character.c_str(), std::to_string(hits).c_str(),
          fmt::format("{}", duration_s).c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  other.questions_ = fdopen(dup(question->write.get()), "w");
  other.answers_ = fdopen(dup(answer->read.get()), "r");
  answer->write.reset();
  question->read.reset();
  if (line_of(other.answers_) != kServe) return other.silent();
  return other;
}

OtherBuild::OtherBuild(OtherBuild&& other) noexcept
    : program_(std::move(other.program_)),
      pid_(std::exchange(other.pid_, -1)),
      questions_(std::exchange(other.questions_, nullptr)),
      answers_(std::exchange(other.answers_, nullptr)) {}

OtherBuild::~OtherBuild() {
  if (questions_ != nullptr) std::fclose(questions_);
  if (answers_ != nullptr) std::fclose(answers_);
  if (pid_ > 0) wait_for_end(pid_);
}

Error OtherBuild::silent() const {
  return usage_error(fmt::format("'{}' does not answer as a bench program", program_),
                     "name the ukemi_bench of another build, from this version on");
}

Result<Sample> OtherBuild::sample(int hit, const std::string& run) {
  std::fprintf(questions_, "%d %s\n", hit, run.c_str());
  std::fflush(questions_);
  try {
    return nlohmann::json::parse(line_of(answers_)).get<Sample>();
  } catch (const nlohmann::json::exception&) {
    return silent();
  }
}

}  // namespace ukemi
