#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "cli/commands.h"
#include "cli/console.h"

namespace {

/// A standard stream that the caller closed is taken up, lest a file that is opened later receive what is
/// printed. Writing to stdout or stderr still fails.
void take_up_closed_streams() {
  for (int stream = 0; stream <= 2; ++stream)
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

}  // namespace

int main(int count, char** words) {
  take_up_closed_streams();
  std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away ends the writing, not the program
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error, not the program's end
  try {
    return ukemi::run({words + (count > 0 ? 1 : 0), words + count});
  } catch (const std::bad_alloc&) {
    return ukemi::print_error({ukemi::ErrorKind::input, "", 0, 0, "", "this needs more memory than there is",
                               "use simpler files, a shorter clip or fewer frames per second"});
  } catch (const std::exception& error) {
    return ukemi::print_error(
        {ukemi::ErrorKind::internal, "", 0, 0, "", std::string("unexpected failure: ") + error.what(),
         "this is a bug of the program; report it with the command line and the input file"});
  }
}
