#include "batch/workers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <memory>
#include <new>
#include <optional>
#include <string_view>

#include "base/descriptors.h"
#include "base/errors.h"
#include "base/process.h"

namespace ukemi {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr int kOutOfMemory = 77;  // exit status of a worker
constexpr int kThrew = 78;        // likewise
constexpr auto kPatience = std::chrono::milliseconds(100);
constexpr double kGrace_s = 0.5;          // for jobs under way when the batch is stopped
constexpr std::size_t kComplaint = 2000;  // bytes kept of what a worker says on stderr

std::optional<std::string> take_line(std::string& text) {
  const auto end = text.find('\n');
  if (end == text.npos) return std::nullopt;
  std::string line = text.substr(0, end);
  text.erase(0, end + 1);
  return line;
}

std::string answer_or_exit(const Work& work, const std::string& job) {
  try {
    return work(job) + "\n";
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (const std::exception& exception) {
    static_cast<void>(write_all(STDERR_FILENO, exception.what()));
    _exit(kThrew);
  }
}

/// A worker's life: a job per line of `in` until it ends.
[[noreturn]] void serve(int in, int out, int err, pid_t parent, const WorkerSettings& settings,
                        const Work& work) {
  if (!die_with(parent)) _exit(0);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) signal(signal_number, SIG_IGN);
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  leave_no_core();
  if (settings.memory_bytes > 0) limit_addresses(settings.memory_bytes);
  std::string input;
  while (true) {
    while (const auto job = take_line(input))
      if (!write_all(out, answer_or_exit(work, *job))) _exit(0);
    if (!read_some(in, input)) _exit(0);
  }
}

/// A worker as its parent sees it.
struct Worker {
  pid_t pid = -1;
  Descriptor jobs, answers, complaints;
  std::string answer, complaint;  // what has come so far
  std::optional<std::size_t> job;
  Clock::time_point deadline;
  bool late = false;
};

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

std::string reason_of(const Worker& worker, int status, const WorkerSettings& settings) {
  const std::string said = last_line(worker.complaint);
  const std::string after = said.empty() ? "" : ": " + said;
  if (worker.late) return fmt::format("took longer than {} s", settings.job_timeout_s);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
    return "was killed (signal 9): the system may have run out of memory" + after;
  if (WIFSIGNALED(status))
    return fmt::format("crashed: signal {} ({}){}", WTERMSIG(status), strsignal(WTERMSIG(status)), after);
  if (WEXITSTATUS(status) == kOutOfMemory)
    return fmt::format("ran out of memory ({} MB)", settings.memory_bytes >> 20);
  return fmt::format("ended with status {}{}", WEXITSTATUS(status), after);
}

class Pool {
 public:
  Pool(const std::vector<std::string>& jobs, const WorkerSettings& settings, const Work& work,
       const std::function<void(const JobEnd&)>& ended)
      : jobs_(jobs), settings_(settings), work_(work), ended_(ended), tries_(jobs.size(), 0) {
    for (std::size_t i = 0; i < jobs.size(); ++i) waiting_.push_back(i);
  }
  ~Pool() {
    for (const auto& worker : workers_) kill(worker->pid, SIGKILL);
    for (const auto& worker : workers_) wait_for_end(worker->pid);
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  Status run(const std::function<bool()>& stopped) {
    std::optional<Clock::time_point> last_moment;
    while (true) {
      if (!last_moment && stopped()) last_moment = Clock::now() + to_clock(kGrace_s);
      if (!last_moment)
        if (const Status status = give_out_jobs(); !status) return status;
      if (!busy() || (last_moment && Clock::now() >= *last_moment)) return Done{};
      listen();
      end_late_jobs();
    }
  }

 private:
  static Clock::duration to_clock(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
  }

  bool busy() const {
    return std::any_of(workers_.begin(), workers_.end(), [](const auto& worker) { return worker->job; });
  }

  Status give_out_jobs() {
    while (!waiting_.empty()) {
      Worker* idle = idle_worker();
      if (!idle && static_cast<int>(workers_.size()) < settings_.workers) idle = start_worker();
      if (!idle && workers_.empty())
        return internal_error(fmt::format("cannot start a worker: {}", std::strerror(errno)),
                              "end other programs, or raise the limit of processes");
      if (!idle) break;
      give(*idle);
    }
    return Done{};
  }

  Worker* idle_worker() {
    const auto idle = std::find_if(workers_.begin(), workers_.end(), [](const auto& w) { return !w->job; });
    return idle == workers_.end() ? nullptr : idle->get();
  }

  void give(Worker& worker) {
    worker.job = waiting_.front();
    waiting_.pop_front();
    ++tries_[*worker.job];
    worker.complaint.clear();
    worker.deadline = Clock::now() + to_clock(settings_.job_timeout_s);
    // A worker that is gone already is noticed when its answers end.
    static_cast<void>(write_all(worker.jobs.get(), jobs_[*worker.job] + "\n"));
  }

  Worker* start_worker() {
    auto job = make_pipe(), answer = make_pipe(), complaint = make_pipe();
    if (!job || !answer || !complaint) return nullptr;
    const pid_t parent = getpid();
    const pid_t pid = fork();
    if (pid < 0) return nullptr;
    if (pid == 0) {
      for (const auto& other : workers_) {
        other->jobs.reset();
        other->answers.reset();
        other->complaints.reset();
      }
      job->write.reset();
      answer->read.reset();
      serve(job->read.get(), answer->write.get(), complaint->write.get(), parent, settings_, work_);
    }
    auto worker = std::make_unique<Worker>();
    worker->pid = pid;
    worker->jobs = std::move(job->write);
    worker->answers = std::move(answer->read);
    worker->complaints = std::move(complaint->read);
    workers_.push_back(std::move(worker));
    return workers_.back().get();
  }

  /// Waits a moment for any worker to say something.
  void listen() {
    std::vector<pollfd> sources;
    for (const auto& worker : workers_) {
      sources.push_back({worker->answers.get(), POLLIN, 0});
      sources.push_back({worker->complaints.get(), POLLIN, 0});
    }
    if (poll(sources.data(), sources.size(), static_cast<int>(kPatience.count())) <= 0) return;
    std::vector<Worker*> gone;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      Worker& worker = *workers_[i];
      if (sources[2 * i + 1].revents != 0) take_complaint(worker);
      if (sources[2 * i].revents != 0 && !take_answer(worker)) gone.push_back(&worker);
    }
    for (Worker* worker : gone) bury(*worker);
  }

  static void take_complaint(Worker& worker) {
    if (!read_some(worker.complaints.get(), worker.complaint)) worker.complaints.reset();
    if (worker.complaint.size() > kComplaint) worker.complaint.erase(0, worker.complaint.size() - kComplaint);
  }

  /// False where the worker is gone.
  bool take_answer(Worker& worker) {
    if (!read_some(worker.answers.get(), worker.answer)) return false;
    if (auto line = take_line(worker.answer); line && worker.job) {
      const std::size_t job = *worker.job;
      worker.job.reset();
      ended_({job, std::move(*line), ""});
    }
    return true;
  }

  /// The job of a worker that died is tried once more.
  void bury(Worker& worker) {
    if (worker.complaints.get() >= 0) take_complaint(worker);
    const int status = wait_for_end(worker.pid);
    if (worker.job && tries_[*worker.job] < 2)
      waiting_.push_back(*worker.job);
    else if (worker.job)
      ended_({*worker.job, "", reason_of(worker, status, settings_)});
    std::erase_if(workers_, [&](const auto& other) { return other.get() == &worker; });
  }

  void end_late_jobs() {
    for (const auto& worker : workers_) {
      if (!worker->job || worker->late || Clock::now() < worker->deadline) continue;
      worker->late = true;
      kill(worker->pid, SIGKILL);  // its answers end then
    }
  }

  const std::vector<std::string>& jobs_;
  const WorkerSettings& settings_;
  const Work& work_;
  const std::function<void(const JobEnd&)>& ended_;
  std::vector<int> tries_;
  std::deque<std::size_t> waiting_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace

Status run_jobs(const std::vector<std::string>& jobs, const WorkerSettings& settings, const Work& work,
                const std::function<void(const JobEnd&)>& ended, const std::function<bool()>& stopped) {
  signal(SIGPIPE, SIG_IGN);  // a worker may die at any moment
  signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is a failed write
  return Pool(jobs, settings, work, ended).run(stopped);
}

}  // namespace ukemi
