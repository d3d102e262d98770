#include "cli/commands.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "base/errors.h"
#include "base/nearest.h"
#include "base/version.h"
#include "cli/console.h"
#include "cli/help_pages.h"

namespace ukemi {
namespace {

struct Command {
  std::string_view name;
  std::string_view arguments;
  std::string_view summary;
  int (*run)(const Arguments&);
};

constexpr std::array<Command, 12> kCommands = {{
    {"bake", "CHARACTER", "one hit reaction of a character: clip, contact sheet, report", bake_command},
    {"batch", "RECIPE", "many reactions, in many processes, resumable", batch_command},
    {"recipe", "", "prints a commented recipe for batch", recipe_command},
    {"inspect", "FILE", "what is in a file: skeleton, humanoid map, units, clips, range of motion",
     inspect_command},
    {"render", "FILE...", "contact sheet or moving picture of clips in files", render_command},
    {"review", "DIR", "the web page to judge a folder of reactions by", review_command},
    {"compare", "CHARACTER", "the same random hits with every method of joint restriction", compare_command},
    {"judge", "CLIP", "which criteria of human motion a clip meets, and its score", judge_command},
    {"diff", "A B", "compares two clips joint by joint", diff_command},
    {"rom", "", "range of motion of the joints, and a clip's path through it, as picture or text",
     rom_command},
    {"calibrate", "FILE...", "thresholds of the active restriction from clips of people who stand and walk",
     calibrate_command},
    {"help", "TOPIC", "a page to read, or a command's options", help_command},
}};

std::string overview() {
  std::string text =
      "ukemi bakes hit reactions: a humanoid character and an impact in, a clip whose joints stay human "
      "out\n\n"
      "usage: ukemi COMMAND ...\n\n";
  for (const Command& command : kCommands)
    text +=
        fmt::format("  {:<18} {}\n", fmt::format("{} {}", command.name, command.arguments), command.summary);
  text += "\npages, with ukemi help TOPIC:\n\n";
  for (const std::string& topic : help_topics()) {
    const auto page = help_page(topic);
    text += fmt::format("  {:<18} {}\n", topic, page ? title_of(*page) : "");
  }
  return text +
         "\nukemi COMMAND --help prints the options of a command; ukemi --version the version.\n\n"
         "exit status: 0 done; 1 done, but a check said no; 2 something must change (command line, input "
         "file);\n"
         "             3 the simulation failed; 4 cannot write; 70 a bug of the program\n\n"
         "example: ukemi bake mannequin --hit torso --from front -o hit.glb -o hit.bvh --sheet hit.png\n";
}

int refuse(const std::string& what, const std::string& fix) { return print_error(usage_error(what, fix)); }

}  // namespace

int run(const Arguments& arguments) {
  if (arguments.empty()) return refuse("no command", "see ukemi --help");
  const std::string& word = arguments.front();
  if (word == "--help" || word == "-h") return print_result(overview(), 0);
  if (word == "--version") return print_result(generator() + "\n", 0);
  for (const Command& command : kCommands)
    if (command.name == word) return command.run(Arguments(arguments.begin() + 1, arguments.end()));
  if (word.starts_with('-')) return refuse(fmt::format("unknown option '{}'", word), "see ukemi --help");
  return refuse(fmt::format("unknown command '{}'", word), suggestion(word, command_names()));
}

std::vector<std::string> command_names() {
  std::vector<std::string> names;
  for (const Command& command : kCommands) names.emplace_back(command.name);
  return names;
}

}  // namespace ukemi
