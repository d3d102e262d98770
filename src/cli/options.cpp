#include "cli/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "base/errors.h"
#include "base/nearest.h"
#include "cli/console.h"

namespace ukemi {
namespace {

constexpr std::size_t kNameColumn = 28;
constexpr std::size_t kLineWidth = 100;

/// Breaks between words so that no line is longer than `width`.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::size_t length = end - begin;
    const std::size_t newline = text.substr(begin, length).rfind('\n');
    if (line > 0 && line + 1 + length > width) {
      result += '\n';
      line = 0;
    } else if (line > 0) {
      result += ' ';
      ++line;
    }
    result.append(text, begin, length);
    line = newline == std::string::npos ? line + length : length - newline - 1;
    begin = end + 1;
  }
  return result;
}

/// Layout of `ukemi COMMAND --help`.
class HelpLayout : public CLI::Formatter {
 public:
  HelpLayout() { column_width(kNameColumn); }

  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode mode) const override {
    std::string text =
        fmt::format("{}\n\nusage: ukemi {}", wrapped(app->get_description(), kLineWidth), app->get_name());
    for (const CLI::Option* option :
         app->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      text += " " + option->get_name(true, false);
    std::string groups = make_groups(app, mode);
    for (auto gap = groups.find("\n\n\n"); gap != std::string::npos; gap = groups.find("\n\n\n", gap))
      groups.erase(gap, 1);
    return text + " [options]\n" + make_positionals(app) + groups + app->get_footer() +
           (app->get_footer().empty() ? "" : "\n");
  }

  std::string make_group(std::string title, bool positional,
                         std::vector<const CLI::Option*> options) const override {
    std::string text = positional ? "\n" : fmt::format("\n{}:\n", title);
    for (const CLI::Option* option : options) text += make_option(option, positional);
    return text;
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_name().empty() ? "" : " " + option->get_type_name();
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), kLineWidth - kNameColumn);
  }
};

std::string with_notes(const std::string& help, std::vector<std::string> notes) {
  notes.erase(std::remove(notes.begin(), notes.end(), ""), notes.end());
  return notes.empty() ? help : fmt::format("{} [{}]", help, fmt::join(notes, "; "));
}

/// "--pre-roll" and "--lead" of "--pre-roll,--lead".
std::vector<std::string> long_names(const std::string& names) {
  std::vector<std::string> found;
  for (std::size_t begin = 0; begin < names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    if (names.compare(begin, 2, "--") == 0) found.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return found;
}

template <typename Target>
std::function<Status(const std::string&)> take_number(Target& target, const Range& range) {
  return [&target, range](const std::string& text) -> Status {
    const auto value = parse_number(text, range);
    if (!value) return value.error();
    target = *value;
    return Done{};
  };
}

template <typename Target, typename Number>
std::function<Status(const std::string&)> take_whole(Target& target, Number low, Number high) {
  return [&target, low, high](const std::string& text) -> Status {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [parsed, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || parsed != end || value < low || value > high)
      return usage_error(fmt::format("'{}' is not a whole number from {} to {}", text, low, high),
                         fmt::format("give a whole number from {} to {}", low, high));
    target = value;
    return Done{};
  };
}

}  // namespace

struct Options::Parser {
  CLI::App app;
  std::string group = "options";
  bool everyday = true;
  bool shows_all = false;
  std::vector<CLI::Option*> rare;      // not for every day
  std::vector<std::string> names;      // every long option
  std::optional<Error> error;          // the first refusal of a value
  std::vector<std::string> arguments;  // names of the positional ones

  /// Declares an option whose values go, as text, to `take`.
  CLI::Option* declare(const std::string& flags, const std::string& value, const std::string& help, bool list,
                       std::function<Status(const std::string&)> take) {
    const std::string name = long_names(flags).front();
    CLI::callback_t callback = [this, take = std::move(take), name, list](const CLI::results_t& values) {
      if (!list && values.size() > 1 && !error)
        error = usage_error(fmt::format("{} is given {} times", name, values.size()), "give it once");
      for (const std::string& text : values) {
        const Status status = take(text);
        if (status || error) continue;
        error = status.error();
        error->what = fmt::format("{}: {}", name, error->what);
      }
      return true;
    };
    CLI::Option* option = app.add_option(flags, std::move(callback), help);
    option->type_name(value)->type_size(1)->expected(1)->group(group);
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    keep(option, flags);
    return option;
  }

  void declare_flag(const std::string& flags, std::function<void()> take, const std::string& help) {
    keep(app.add_flag_callback(flags, std::move(take), help)->group(group), flags);
  }

  void keep(CLI::Option* option, const std::string& flags) {
    if (!everyday) rare.push_back(option);
    for (std::string& name : long_names(flags)) names.push_back(std::move(name));
  }

  void hide_rare() {
    for (CLI::Option* option : rare) option->group("");
    app.footer(
        fmt::format("\nukemi {0} --help-all shows all options, {1} more.", app.get_name(), rare.size()));
  }

  Error unknown(const std::string& argument) const {
    if (argument.size() > 1 && argument.front() == '-') {
      const std::string name = argument.substr(0, argument.find('='));
      const std::string near = nearest_word(name, names);
      return usage_error(fmt::format("unknown option '{}'", name),
                         near.empty() ? fmt::format("see ukemi {} --help", app.get_name())
                                      : fmt::format("did you mean '{}'?", near));
    }
    return usage_error(fmt::format("unexpected argument '{}'", argument),
                       fmt::format("see ukemi {} --help", app.get_name()));
  }
};

Options::Options(const std::string& command, const std::string& summary)
    : parser_(std::make_unique<Parser>()) {
  parser_->app.name(command);
  parser_->app.description(summary);
  parser_->app.formatter(std::make_shared<HelpLayout>());
  parser_->app.set_help_flag("-h,--help", "print this")->group("");
  parser_->app.allow_extras();
  parser_->names.push_back("--help");
}

Options::~Options() = default;

void Options::group(const std::string& title) { parser_->group = title; }

void Options::everyday(bool everyday) {
  parser_->everyday = everyday;
  if (everyday || parser_->app.get_help_all_ptr()) return;
  parser_->app.set_help_all_flag("--help-all", "print every option")->group("");
  parser_->names.push_back("--help-all");
}

void Options::argument(const std::string& name, std::string& target, const std::string& help) {
  parser_->arguments.push_back(name);
  CLI::callback_t take = [this, &target, name](const CLI::results_t& values) {
    target = values.front();
    if (target.empty() && !parser_->error) parser_->error = usage_error(name + " is empty", "name a file");
    return true;
  };
  parser_->app.add_option(name, std::move(take), help)->type_name("")->type_size(1)->expected(1)->required();
}

void Options::arguments(const std::string& name, std::vector<std::string>& target, const std::string& help) {
  parser_->arguments.push_back(name);
  CLI::Option* option =
      parser_->app.add_option(name, CLI::callback_t([&target](const CLI::results_t& values) {
                                target = values;
                                return true;
                              }),
                              help);
  option->type_name("")->type_size(1)->expected(-1)->allow_extra_args();
  option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void Options::custom(const std::string& names, const std::string& value,
                     std::function<Status(const std::string&)> take, const std::string& help, bool list,
                     const std::string& bare) {
  const auto take_bare = [take, bare](const std::string& text) {
    return take(!bare.empty() && (text.empty() || text == "true") ? bare : text);
  };
  CLI::Option* option = parser_->declare(
      names, value,
      with_notes(help, {list ? "may be repeated" : "", bare.empty() ? "" : bare + " where S is left out"}),
      list, take_bare);
  if (!bare.empty()) option->expected(0, 1);
}

void Options::text(const std::string& names, const std::string& value, std::string& target,
                   const std::string& help) {
  parser_->declare(names, value, with_notes(help, {"default " + target}), false,
                   [&target](const std::string& text) {
                     target = text;
                     return Status(Done{});
                   });
}

void Options::text(const std::string& names, const std::string& value, std::optional<std::string>& target,
                   const std::string& help) {
  custom(
      names, value,
      [&target](const std::string& text) {
        target = text;
        return Status(Done{});
      },
      help);
}

void Options::number(const std::string& names, const std::string& unit, double& target, const Range& range,
                     const std::string& help) {
  parser_->declare(names, unit, with_notes(help, {fmt::format("default {}", target), range.text()}), false,
                   take_number(target, range));
}

void Options::number(const std::string& names, const std::string& unit, std::optional<double>& target,
                     const Range& range, const std::string& help) {
  parser_->declare(names, unit, with_notes(help, {range.text()}), false, take_number(target, range));
}

void Options::whole(const std::string& names, const std::string& unit, int& target, int low, int high,
                    const std::string& help, const std::string& otherwise) {
  const std::string without = otherwise.empty() ? fmt::format("default {}", target) : otherwise;
  parser_->declare(names, unit, with_notes(help, {without, fmt::format("{} to {}", low, high)}), false,
                   take_whole(target, low, high));
}

void Options::whole(const std::string& names, const std::string& unit, std::optional<int>& target, int low,
                    int high, const std::string& help, const std::string& otherwise) {
  parser_->declare(names, unit, with_notes(help, {otherwise, fmt::format("{} to {}", low, high)}), false,
                   take_whole(target, low, high));
}

void Options::whole(const std::string& names, const std::string& unit, std::uint64_t& target,
                    std::uint64_t low, std::uint64_t high, const std::string& help) {
  parser_->declare(names, unit, with_notes(help, {fmt::format("default {}", target)}), false,
                   take_whole(target, low, high));
}

void Options::path(const std::string& names, std::filesystem::path& target, const std::string& help,
                   const std::string& value) {
  custom(
      names, value,
      [&target](const std::string& text) -> Status {
        if (text.empty()) return usage_error("the file's name is empty", "name a file");
        target = text;
        return Done{};
      },
      help);
}

void Options::paths(const std::string& names, std::vector<std::filesystem::path>& target,
                    const std::string& help, const std::string& value) {
  custom(
      names, value,
      [&target](const std::string& text) -> Status {
        if (text.empty()) return usage_error("the file's name is empty", "name a file");
        target.emplace_back(text);
        return Done{};
      },
      help, true);
}

void Options::flag(const std::string& names, bool& target, const std::string& help) {
  flag(
      names, [&target] { target = true; }, help);
}

void Options::flag(const std::string& names, std::function<void()> take, const std::string& help) {
  parser_->declare_flag(names, std::move(take), help);
}

void Options::on_off(const std::string& name, bool on, std::function<void(bool)> take,
                     const std::string& help, const std::string& opposite) {
  parser_->declare_flag(
      "--" + name, [take] { take(true); }, with_notes(help, {on ? "default" : ""}));
  parser_->declare_flag(
      "--no-" + name, [take] { take(false); }, with_notes(opposite, {on ? "" : "default"}));
}

Result<Options::Outcome> Options::parse(const std::vector<std::string>& arguments) {
  CLI::App& app = parser_->app;
  const std::string see = fmt::format("see ukemi {} --help", app.get_name());
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    return Outcome::help;
  } catch (const CLI::CallForAllHelp&) {
    parser_->shows_all = true;
    return Outcome::help;
  } catch (const CLI::RequiredError&) {
    if (parser_->error) return *parser_->error;
    const auto extras = app.remaining();
    for (const std::string& extra : extras)
      if (extra.size() > 1 && extra.front() == '-') return parser_->unknown(extra);
    return usage_error(fmt::format("{} is missing", fmt::join(parser_->arguments, " or ")), see);
  } catch (const CLI::ArgumentMismatch& mismatch) {
    return usage_error(mismatch.what(), see);
  } catch (const CLI::ParseError& error) {
    return usage_error(error.what(), see);
  }
  if (parser_->error) return *parser_->error;
  for (const std::string& extra : app.remaining())
    if (extra != "--") return parser_->unknown(extra);
  return Outcome::run;
}

std::string Options::help() const {
  if (!parser_->rare.empty() && !parser_->shows_all) parser_->hide_rare();
  return parser_->app.help();
}

std::optional<int> status_at_once(Options& options, const std::vector<std::string>& arguments,
                                  const std::string& further) {
  const auto outcome = options.parse(arguments);
  if (!outcome) return print_error(outcome.error());
  if (*outcome == Options::Outcome::help) return print_result(options.help() + further, 0);
  return std::nullopt;
}

}  // namespace ukemi
