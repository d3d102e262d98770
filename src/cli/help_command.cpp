#include <algorithm>

#include "base/errors.h"
#include "base/nearest.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/help_pages.h"

namespace ukemi {

int help_command(const Arguments& arguments) {
  if (arguments.empty() || arguments.front() == "--help") return run({"--help"});
  if (arguments.size() > 1)
    return print_error(usage_error("more than one topic", "ask for one of them: ukemi help TOPIC"));
  const std::string& topic = arguments.front();
  std::vector<std::string> known = help_topics();
  const std::vector<std::string> commands = command_names();
  const bool is_page = std::find(known.begin(), known.end(), topic) != known.end();
  if (!is_page && std::find(commands.begin(), commands.end(), topic) != commands.end())
    return run({topic, "--help"});
  known.insert(known.end(), commands.begin(), commands.end());
  if (!is_page) return print_error(usage_error("no page '" + topic + "'", suggestion(topic, known)));
  const auto page = help_page(topic);
  return page ? print_result(*page, 0) : print_error(page.error());
}

}  // namespace ukemi
