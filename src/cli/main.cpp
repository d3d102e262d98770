#include <csignal>
#include <cstdio>
#include <exception>

#include "cli/commands.h"
#include "cli/console.h"

int main(int count, char** words) {
  std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away ends the writing, not the program
  try {
    return ukemi::run({words + (count > 0 ? 1 : 0), words + count});
  } catch (const std::exception& error) {
    return ukemi::print_error(
        {ukemi::ErrorKind::internal, "", 0, 0, "", std::string("unexpected failure: ") + error.what(),
         "this is a bug of the program; report it with the command line and the input file"});
  }
}
