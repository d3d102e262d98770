#include "batch/workers.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <vector>

namespace ukemi {
namespace {

/// Ends by job, in the order they came.
struct Ends {
  std::vector<JobEnd> all;
  std::map<std::size_t, JobEnd> by_job;
};

Ends run(
    const std::vector<std::string>& jobs, const WorkerSettings& settings, const Work& work,
    const std::function<bool(const Ends&)>& stopped = [](const Ends&) { return false; }) {
  Ends ends;
  const Status status = run_jobs(
      jobs, settings, work,
      [&](const JobEnd& end) {
        ends.all.push_back(end);
        EXPECT_TRUE(ends.by_job.emplace(end.job, end).second) << "ended twice: " << end.job;
      },
      [&] { return stopped(ends); });
  EXPECT_TRUE(status);
  return ends;
}

std::string echo(const std::string& job) { return "did " + job; }

[[noreturn]] void hang() {
  while (true) pause();
}

TEST(Workers, AnswerEveryJobOnce) {
  std::vector<std::string> jobs;
  for (int i = 0; i < 200; ++i) jobs.push_back(std::to_string(i));
  for (const int workers : {1, 2, 7}) {
    const Ends ends = run(jobs, {workers, 60.0, 0}, echo);
    ASSERT_EQ(ends.by_job.size(), jobs.size());
    for (const auto& [job, end] : ends.by_job) {
      EXPECT_EQ(end.answer, "did " + jobs[job]);
      EXPECT_EQ(end.failure, "");
    }
  }
}

TEST(Workers, KeepWhatTheyLearnFromJobToJob) {
  const Work count = [n = 0](const std::string&) mutable { return std::to_string(++n); };
  const Ends ends = run({"a", "b", "c"}, {1, 60.0, 0}, count);
  EXPECT_EQ(ends.all.back().answer, "3");
}

TEST(Workers, TakeLinesThatAreLargerThanAPipe) {
  const std::string large(1 << 20, 'x');
  const Ends ends = run({large, large}, {2, 60.0, 0}, echo);
  ASSERT_EQ(ends.all.size(), 2u);
  EXPECT_EQ(ends.all[0].answer.size(), large.size() + 4);
}

TEST(Workers, ACrashCostsItsJobAlone) {
  const Work work = [](const std::string& job) {
    if (job == "crash") {
      const std::string_view said = "something is wrong\n";
      EXPECT_GT(write(STDERR_FILENO, said.data(), said.size()), 0);
      raise(SIGSEGV);
    }
    return echo(job);
  };
  for (const int workers : {1, 2}) {
    const Ends ends = run({"a", "crash", "b", "c"}, {workers, 60.0, 0}, work);
    ASSERT_EQ(ends.all.size(), 4u);
    EXPECT_EQ(ends.by_job.at(0).answer, "did a");
    EXPECT_EQ(ends.by_job.at(2).answer, "did b");
    EXPECT_EQ(ends.by_job.at(3).answer, "did c");
    EXPECT_EQ(ends.by_job.at(1).answer, "");
    if (workers == 1) {
      EXPECT_EQ(ends.all.back().job, 1u) << "tried again after the others";
    }
#ifndef __SANITIZE_ADDRESS__
    EXPECT_EQ(ends.by_job.at(1).failure, "crashed: signal 11 (Segmentation fault): something is wrong");
#endif
  }
}

TEST(Workers, AJobThatFailsOnceIsTriedAgain) {
  const std::string mark = testing::TempDir() + "ukemi_tried_" + std::to_string(getpid());
  const Work work = [mark](const std::string& job) {
    if (job == "b" && access(mark.c_str(), F_OK) != 0) {
      fclose(fopen(mark.c_str(), "w"));
      raise(SIGKILL);
    }
    return echo(job);
  };
  const Ends ends = run({"a", "b", "c"}, {2, 60.0, 0}, work);
  unlink(mark.c_str());
  ASSERT_EQ(ends.all.size(), 3u);
  EXPECT_EQ(ends.by_job.at(1).answer, "did b");
}

TEST(Workers, OneThatHangsIsEnded) {
  const Work work = [](const std::string& job) {
    if (job == "hang") hang();
    return echo(job);
  };
  const Ends ends = run({"hang", "a", "b"}, {2, 0.3, 0}, work);
  ASSERT_EQ(ends.all.size(), 3u);
  EXPECT_EQ(ends.by_job.at(0).failure, "took longer than 0.3 s");
  EXPECT_EQ(ends.by_job.at(2).answer, "did b");
}

TEST(Workers, OneThatEatsTheMemoryLosesItsJobAlone) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "address space is not limited under the sanitizer";
#endif
  const Work work = [](const std::string& job) {
    std::vector<std::vector<char>> eaten;
    while (job == "eat") eaten.emplace_back(1 << 24, 'x');
    return echo(job);
  };
  const Ends ends = run({"eat", "a"}, {1, 60.0, 512u << 20}, work);
  ASSERT_EQ(ends.all.size(), 2u);
  EXPECT_EQ(ends.by_job.at(0).failure, "ran out of memory (512 MB)");
  EXPECT_EQ(ends.by_job.at(1).answer, "did a");
}

TEST(Workers, AnExceptionIsToldAsTheReason) {
  const Work work = [](const std::string& job) -> std::string { throw std::runtime_error("no " + job); };
  const Ends ends = run({"a"}, {1, 60.0, 0}, work);
  EXPECT_EQ(ends.all.at(0).failure, "ended with status 78: no a");
}

TEST(Workers, StopWithinASecondAndKeepWhatHasEnded) {
  const Work work = [](const std::string& job) {
    if (job == "hang") hang();
    return echo(job);
  };
  const auto start = std::chrono::steady_clock::now();
  const Ends ends = run({"a", "hang", "b", "c"}, {1, 60.0, 0}, work,
                        [](const Ends& so_far) { return !so_far.all.empty(); });
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(ends.all.size(), 1u);
  EXPECT_LT(took.count(), 1.0);
}

TEST(Workers, LetJobsThatAreNearlyDoneEnd) {
  const Work work = [](const std::string& job) {
    usleep(200000);
    return echo(job);
  };
  bool asked = false;
  const Ends ends = run({"a", "b"}, {1, 60.0, 0}, work, [&asked](const Ends&) {
    return std::exchange(asked, true);  // once the first job is under way
  });
  ASSERT_EQ(ends.all.size(), 1u);
  EXPECT_EQ(ends.all[0].answer, "did a");
}

TEST(Workers, NoJobsNeedNoWorkers) { EXPECT_TRUE(run({}, {2, 60.0, 0}, echo).all.empty()); }

}  // namespace
}  // namespace ukemi
