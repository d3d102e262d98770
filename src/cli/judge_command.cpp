#include <fmt/format.h>

#include <optional>
#include <string>

#include "base/errors.h"
#include "check/judge_clip.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/settings_options.h"

namespace ukemi {
namespace {

constexpr double kLongest_s = 86400.0;

Status take_kind(const std::string& word, JudgeSettings& settings) {
  for (const ReactionKind kind : {ReactionKind::stand, ReactionKind::fall, ReactionKind::get_up})
    if (word == name(kind)) {
      settings.kind = kind;
      return Done{};
    }
  return usage_error(fmt::format("unknown mode '{}'", word), "use stand, fall or getup");
}

Status take_segment(const std::string& word, JudgeSettings& settings) {
  settings.hit = segment_named(word);
  if (settings.hit) return Done{};
  return usage_error(fmt::format("unknown segment '{}'", word), "see ukemi inspect for the segments' names");
}

void declare(Options& options, JudgeClipSettings& settings) {
  JudgeSettings& judge = settings.judge;
  options.group("what is judged");
  options.number("--impact", "S", judge.impact_s, Range{0.0, kLongest_s},
                 "time of the blow [default: as baked into the clip, else found]");
  options.number("--from", "S", judge.from_s, Range{0.0, kLongest_s},
                 "time from which on the blow is looked for");
  options.number("--to", "S", judge.to_s, Range{0.0, kLongest_s},
                 "time until which the clip is judged [default: the end]");
  options.custom(
      "--mode", "stand|fall|getup", [&judge](const std::string& word) { return take_kind(word, judge); },
      "what the clip shows [default: found]");
  options.group("the blow");
  options.number("--momentum", "N_S", judge.momentum_n_s, Range{0.0, 10000.0},
                 "momentum of the blow: some criteria apply to some strengths [default: unknown]");
  options.custom(
      "--hit", "SEGMENT", [&judge](const std::string& word) { return take_segment(word, judge); },
      "segment that the blow hit [default: unknown]");
  options.flag("--ko", judge.knock_out, "a knock-out: the body does not protect itself");
  options.group("the body");
  options.number("--mass", "KG", settings.mass_kg, Range{1.0, 1000.0},
                 "mass of the body [default: that of a man of the figure's height]");
}

}  // namespace

int judge_command(const Arguments& arguments) {
  JudgeClipSettings settings;
  bool json = false;
  Options options(
      "judge",
      "says which criteria of human motion a clip meets. There are criteria for a body that stays up, falls "
      "or gets up; the joints' places tell which it does.\nThe score is the share of the criteria that "
      "apply");
  options.argument("CLIP", settings.file, "a file with motion, or FILE#CLIP [default clip: the last]");
  declare(options, settings);
  declare_humanoid_options(options, settings.humanoid);
  options.flag("--json", json, "as JSON");
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (settings.judge.impact_s && settings.judge.from_s)
    return print_error(usage_error("--impact and --from exclude each other",
                                   "give --impact where the time of the blow is known, --from where it is "
                                   "looked for"));

  Diagnostics diagnostics;
  const auto judged = judge_clip(settings, diagnostics);
  print_warnings(diagnostics);
  if (!judged) return print_error(judged.error());
  return json ? print_json(judgement_json(*judged, diagnostics), 0)
              : print_result(judgement_text(*judged), 0);
}

}  // namespace ukemi
