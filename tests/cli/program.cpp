#include "program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

extern char** environ;

namespace ukemi {
namespace fs = std::filesystem;
namespace {

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The program with its outputs in two files and its working directory in `folder`; -1 where it cannot start.
pid_t spawn(const std::vector<std::string>& arguments, const fs::path& folder, const fs::path& out,
            const fs::path& err) {
  std::vector<char*> words;
  std::string program = UKEMI_PROGRAM;
  words.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& word : copies) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int failed = posix_spawn(&child, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed != 0 ? -1 : child;
}

}  // namespace

void Program::SetUp() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  folder = fs::path(testing::TempDir()) / (std::string("ukemi_") + test->test_suite_name() + "_" +
                                           test->name() + "_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
}

void Program::TearDown() { fs::remove_all(folder); }

pid_t Program::start(const std::vector<std::string>& arguments, const fs::path& out) {
  out_ = out.empty() ? fs::path(folder.string() + ".out") : out;
  err_ = folder.string() + ".err";
  return spawn(arguments, folder, out_, err_);
}

Ran Program::wait(pid_t child) {
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  Ran result;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  result.processor_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.memory_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.err = content_of(err_);
  if (out_ == folder.string() + ".out") {
    result.out = content_of(out_);
    fs::remove(out_);
  }
  fs::remove(err_);
  return result;
}

Ran Program::run(const std::vector<std::string>& arguments, const fs::path& out) {
  return wait(start(arguments, out));
}

std::vector<std::string> Program::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void Program::write(const std::string& name, const std::string& content) const {
  std::ofstream(folder / name, std::ios::binary) << content;
}

std::string Program::read(const std::string& name) const { return content_of(folder / name); }

void Program::expect_refused(const std::vector<std::string>& arguments, int status, const std::string& what) {
  std::string line = "ukemi";
  for (const std::string& word : arguments) line += " " + word;
  SCOPED_TRACE(line);
  const std::vector<std::string> before = files();
  const Ran result = run(arguments);
  EXPECT_EQ(result.status, status);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.rfind("ukemi: error: ", 0), 0u) << result.err;
  EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("\n  fix: "), std::string::npos) << result.err;
  EXPECT_EQ(files(), before);
}

}  // namespace ukemi
