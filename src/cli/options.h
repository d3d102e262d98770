// The options of a command: one declaration gives the parsing, the check, the default and the line in the
// help.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "base/result.h"

namespace ukemi {

/// Contract:
/// 1. Names are "--word", "-x,--word" or "--word,--old-word": refusals name the first --word. Values are
///    taken as text and turned into their type by the declaration, so that every refusal names the option,
///    the value and what is legal.
/// 2. A default stands in the help as it stands in the target when the option is declared.
/// 3. An option given twice is refused, unless it is declared as a list.
/// 4. Where some options are not for every day, --help leaves them out and --help-all shows all.
class Options {
 public:
  Options(const std::string& command, const std::string& summary);
  ~Options();
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  /// Heading of the options declared next.
  void group(const std::string& title);
  /// Whether --help shows the options declared next; true at first.
  void everyday(bool everyday);
  void argument(const std::string& name, std::string& target, const std::string& help);
  /// Any number of them, none included.
  void arguments(const std::string& name, std::vector<std::string>& target, const std::string& help);
  void text(const std::string& names, const std::string& value, std::string& target, const std::string& help);
  void text(const std::string& names, const std::string& value, std::optional<std::string>& target,
            const std::string& help);
  void number(const std::string& names, const std::string& unit, double& target, const Range& range,
              const std::string& help);
  /// Without a default.
  void number(const std::string& names, const std::string& unit, std::optional<double>& target,
              const Range& range, const std::string& help);
  /// A whole number from `low` to `high`; `otherwise` says what is where it is not given, unless that is the
  /// target's value.
  void whole(const std::string& names, const std::string& unit, int& target, int low, int high,
             const std::string& help, const std::string& otherwise = "");
  void whole(const std::string& names, const std::string& unit, std::optional<int>& target, int low, int high,
             const std::string& help, const std::string& otherwise);
  void whole(const std::string& names, const std::string& unit, std::uint64_t& target, std::uint64_t low,
             std::uint64_t high, const std::string& help);
  /// `value`: FILE, or DIR for a folder.
  void path(const std::string& names, std::filesystem::path& target, const std::string& help,
            const std::string& value = "FILE");
  void paths(const std::string& names, std::vector<std::filesystem::path>& target, const std::string& help,
             const std::string& value = "FILE");
  void flag(const std::string& names, bool& target, const std::string& help);
  void flag(const std::string& names, std::function<void()> take, const std::string& help);
  /// --name and --no-name; `on` is the default.
  void on_off(const std::string& name, bool on, std::function<void(bool)> take, const std::string& help,
              const std::string& opposite);
  /// Any value that `take` accepts; repeatable where `list`. What `take` refuses is told with the option's
  /// name before it. `bare`: the value where none follows; empty: one must.
  void custom(const std::string& names, const std::string& value,
              std::function<Status(const std::string&)> take, const std::string& help, bool list = false,
              const std::string& bare = "");

  enum class Outcome { run, help };
  /// Takes the arguments after the command's name. Errors: usage.
  Result<Outcome> parse(const std::vector<std::string>& arguments);
  /// What --help or --help-all prints, whichever was parsed.
  std::string help() const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Takes a command's arguments. Where it ends with that, its exit status: help (and `further`) is printed, or
/// the refusal is.
std::optional<int> status_at_once(Options& options, const std::vector<std::string>& arguments,
                                  const std::string& further = "");

}  // namespace ukemi
