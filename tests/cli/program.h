// Runs the real program in a folder of its own: status, both outputs and the files left behind, together.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ukemi {

struct Ran {
  int status = -1;  // exit status; -1 where the program did not end by itself
  std::string out;
  std::string err;
  double processor_s = 0.0;  // of the program and its children
  double memory_mb = 0.0;    // the most at once
};

class Program : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Starts the program in `folder`; its outputs are read by `wait`, which waits for its end.
  pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& out = {});
  Ran wait(pid_t child);
  /// Both. The program with these arguments, in `folder`; stdout goes to `out` where one is given.
  Ran run(const std::vector<std::string>& arguments, const std::filesystem::path& out = {});
  /// Names of everything in `folder`, sorted.
  std::vector<std::string> files() const;
  void write(const std::string& name, const std::string& content) const;
  std::string read(const std::string& name) const;

  /// Expects a refusal: the status, nothing on stdout, an error that holds `what`, a fix, and no new file.
  void expect_refused(const std::vector<std::string>& arguments, int status, const std::string& what);

  std::filesystem::path folder;

 private:
  std::filesystem::path out_, err_;  // of the program that runs
};

}  // namespace ukemi
