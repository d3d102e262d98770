// The options of a command: one declaration gives the parsing, the check, the default and the line in the
// help.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace ukemi {

/// Legal values of a number; ends are legal unless `above_min`.
struct Range {
  double min = 0.0;
  double max = 0.0;
  bool above_min = false;

  bool contains(double value) const { return (above_min ? value > min : value >= min) && value <= max; }
  std::string text() const;  // "1 to 1000", "above 0, at most 60"
};

/// A number in the whole of `text`, without regard to the locale. Errors: usage; `what` begins with `option`.
Result<double> parse_number(std::string_view option, std::string_view text, const Range& range);

/// Contract:
/// 1. Names are "--word" or "-x,--word". Values are taken as text and turned into their type by the
/// declaration, so
///    that every refusal names the option, the value and what is legal.
/// 2. A default stands in the help as it stands in the target when the option is declared.
/// 3. An option given twice is refused, unless it is declared as a list.
class Options {
 public:
  Options(const std::string& command, const std::string& summary);
  ~Options();
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  /// Heading of the options declared next.
  void group(const std::string& title);
  void argument(const std::string& name, std::string& target, const std::string& help);
  /// Any number of them, none included.
  void arguments(const std::string& name, std::vector<std::string>& target, const std::string& help);
  void text(const std::string& names, const std::string& value, std::string& target, const std::string& help);
  void text(const std::string& names, const std::string& value, std::optional<std::string>& target,
            const std::string& help);
  void number(const std::string& names, const std::string& unit, double& target, const Range& range,
              const std::string& help);
  void number(const std::string& names, const std::string& unit, std::optional<double>& target,
              const Range& range, const std::string& help);
  void path(const std::string& names, std::filesystem::path& target, const std::string& help);
  void paths(const std::string& names, std::vector<std::filesystem::path>& target, const std::string& help);
  void flag(const std::string& names, bool& target, const std::string& help);
  /// --name and --no-name.
  void on_off(const std::string& name, bool& target, const std::string& help, const std::string& opposite);
  /// One of `words`; `take` gets its index. `chosen` is the default.
  void choice(const std::string& names, const std::vector<std::string>& words, std::size_t chosen,
              std::function<void(std::size_t)> take, const std::string& help);
  /// Any value that `take` accepts; repeatable where `list`.
  void custom(const std::string& names, const std::string& value,
              std::function<Status(const std::string&)> take, const std::string& help, bool list = false);

  enum class Outcome { run, help };
  /// Takes the arguments after the command's name. Errors: usage.
  Result<Outcome> parse(const std::vector<std::string>& arguments);
  std::string help() const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace ukemi
