// Jobs in processes of their own: one that crashes, hangs or eats the memory costs nothing but its job.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"

namespace ukemi {

struct WorkerSettings {
  int workers = 1;
  double job_timeout_s = 300.0;         // a job that takes longer is ended
  std::size_t memory_bytes = 4u << 30;  // address space of a worker; 0: any
};

/// How a job ended.
struct JobEnd {
  std::size_t job = 0;  // index
  std::string answer;   // of the work; empty where it failed
  std::string failure;  // why there is no answer: crash, time, memory
};

/// Done in a worker: a line in, a line out. What it keeps between jobs lives as long as its worker.
using Work = std::function<std::string(const std::string& job)>;

/// Runs every job in one of the forked workers, in the order given as workers become free, and tells each
/// end once, in the order of the ends. A job whose worker dies or takes too long is tried once more, in a new
/// worker, when all others have been given out. `stopped` is asked about ten times a second; once it says
/// so, no job is begun, and those that have not ended half a second later are ended. The calling process must
/// have one thread only. Errors: internal (no process can be started).
Status run_jobs(const std::vector<std::string>& jobs, const WorkerSettings& settings, const Work& work,
                const std::function<void(const JobEnd&)>& ended, const std::function<bool()>& stopped);

}  // namespace ukemi
