#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

#include "base/character_path.h"
#include "base/errors.h"
#include "base/files.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/progress_line.h"
#include "cli/settings_options.h"
#include "load/load.h"
#include "study/compare.h"
#include "study/compare_pictures.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

constexpr int kMostHits = 10000;

struct CompareRequest {
  std::string character;
  CompareSettings settings;
  fs::path folder;
  int show = 0;  // hit to draw, from 1; 0: chosen
  bool json = false;
  bool quiet = false;
};

void declare(Options& options, CompareRequest& request) {
  CompareSettings& settings = request.settings;
  options.argument("CHARACTER", request.character,
                   "a .glb .gltf .vrm .fbx .dae .bvh file, or the word mannequin");
  options.group("experiment");
  options.whole("--hits", "N", settings.hits, 1, kMostHits, "random hits for each method");
  options.whole("--seed", "N", settings.seed, 0, UINT64_MAX, "seed of the random hits");
  options.text("--region", "NAME|FILE", settings.region,
               "range of motion that the methods keep to: human diamond box, or a TOML file; all are judged "
               "against human");
  options.number("--duration", "S", settings.duration_s, Range{0.1, 60.0},
                 "time that is simulated of each hit");
  options.group("body");
  declare_humanoid_options(options, settings.humanoid);
  options.group("out");
  options.path("-o,--output", request.folder,
               "folder for compare.json, compare.txt and the pictures; made where it is missing", "DIR");
  options.whole("--show", "HIT", request.show, 1, kMostHits, "which hit is drawn",
                "default: the one in which (a) bends a joint farthest out");
  options.flag("--json", request.json, "JSON to stdout in place of the table");
  options.flag("--quiet", request.quiet, "nothing to stdout, no warnings, no progress");
}

Status check_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path holder = fs::exists(folder, error) ? folder : fs::absolute(folder, error).parent_path();
  const auto cannot = [&](std::string why, std::string fix) {
    return output_error(folder, "cannot write: " + why, std::move(fix));
  };
  if (!fs::is_directory(holder, error))
    return holder == folder
               ? cannot("is not a folder", "name a folder")
               : cannot(fmt::format("there is no folder '{}'", holder.string()), "make the folder first");
  if (access(holder.c_str(), W_OK | X_OK) != 0)
    return cannot(fmt::format("the folder '{}' may not be written to", holder.string()),
                  "choose another folder, or change its permissions");
  return Done{};
}

Status check(const CompareRequest& request) {
  if (request.json && request.quiet)
    return usage_error("--json and --quiet exclude each other", "give one of them");
  if (request.quiet && request.folder.empty())
    return usage_error("nothing to write", "add -o DIR, or leave out --quiet");
  if (request.show > request.settings.hits)
    return usage_error(fmt::format("--show {} is beyond the last hit", request.show),
                       fmt::format("give a number from 1 to {}, or more --hits", request.settings.hits));
  if (request.show > 0 && request.folder.empty())
    return usage_error("--show needs a folder for its picture", "add -o DIR, or leave out --show");
  return request.folder.empty() ? Status(Done{}) : check_folder(request.folder);
}

/// A comparison and the files that it writes.
struct Compared {
  Comparison comparison;
  std::vector<NamedPicture> pictures;
};

Result<Compared> run_comparison(const CompareRequest& request, Diagnostics& diagnostics) {
  const auto path = character_path(request.character);
  if (!path) return path.error();
  const auto loaded = load_character(*path, LoadOptions{}, diagnostics);
  if (!loaded) return loaded.error();
  const ProgressLine line("run", !request.quiet && !request.json);
  auto comparison = compare(request.character, *loaded, request.settings, diagnostics,
                            [&line](int done, int total) { line.show(done, total); });
  if (!comparison) return comparison.error();
  Compared compared{std::move(*comparison), {}};
  if (request.folder.empty()) return compared;
  const int shown = request.show > 0 ? request.show - 1 : hit_to_show(compared.comparison);
  auto pictures = comparison_pictures(*loaded, compared.comparison, shown);
  if (!pictures) return pictures.error();
  compared.pictures = std::move(*pictures);
  return compared;
}

Status write_files(const fs::path& folder, const Compared& compared) {
  PendingFiles files;
  for (const NamedPicture& picture : compared.pictures)
    if (const Status status = files.add(folder / picture.name, picture.png); !status) return status.error();
  const std::string json = comparison_json(compared.comparison), text = comparison_text(compared.comparison);
  if (const Status status = files.add(folder / "compare.json", json); !status) return status.error();
  if (const Status status = files.add(folder / "compare.txt", text); !status) return status.error();
  return files.commit();
}

/// The files of the folder, together, once everything is known.
Status write_folder(const fs::path& folder, const Compared& compared) {
  std::error_code error;
  const bool is_new = fs::create_directory(folder, error);
  if (error)
    return output_error(folder, "cannot make the folder: " + error.message(), "choose another folder");
  const Status status = write_files(folder, compared);
  if (!status && is_new) fs::remove(folder, error);
  return status;
}

}  // namespace

int compare_command(const Arguments& arguments) {
  CompareRequest request;
  request.settings.threads = std::max(1, std::min(2, static_cast<int>(std::thread::hardware_concurrency())));
  Options options("compare",
                  "hits a standing body with random balls, the same with every method of joint restriction, "
                  "and measures how far the joints leave the human range");
  declare(options, request);
  if (const auto status = status_at_once(options, arguments)) return *status;
  if (const Status status = check(request); !status) return print_error(status.error());

  Diagnostics diagnostics;
  const auto compared = run_comparison(request, diagnostics);
  if (!request.quiet) print_warnings(diagnostics);
  if (!compared) return print_error(compared.error());
  if (!request.folder.empty())
    if (const Status status = write_folder(request.folder, *compared); !status)
      return print_error(status.error());
  if (request.quiet) return 0;
  return request.json ? print_json(comparison_json(compared->comparison), 0)
                      : print_result(comparison_text(compared->comparison), 0);
}

}  // namespace ukemi
