// The same work on many things, on several threads.
#pragma once

#include <cstddef>
#include <functional>

#include "base/result.h"

namespace ukemi {

/// Calls work(i) once for each i below `count`, on up to `threads` threads of which the caller's is one.
/// 1. The indices are given out in rising order. What work(i) writes should belong to i alone.
/// 2. after_each(done), if given, follows each success, `done` being how many there are so far; one call at a
///    time.
/// 3. After an error no index is given out any more. The answer is the error of the lowest index that failed,
///    whatever the number of threads.
/// 4. An exception of work or after_each is an error too, of kind internal: none leaves its thread.
Status for_each_parallel(std::size_t count, int threads, const std::function<Status(std::size_t)>& work,
                         const std::function<void(int done)>& after_each = {});

/// What `work` answers; an exception becomes an error of kind internal.
Status without_exceptions(const std::function<Status()>& work);

}  // namespace ukemi
