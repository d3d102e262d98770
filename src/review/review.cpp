#include "review/review.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "base/build_id.h"
#include "base/digest.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/or_null.h"
#include "base/parallel.h"
#include "base/version.h"
#include "review/clip.h"
#include "review/json.h"
#include "review/sources.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxAssetBytes = 16u << 20;
constexpr std::size_t kMaxTableBytes = 1u << 30;
constexpr std::string_view kMarkOfOurPage = "<meta name=\"generator\" content=\"ukemi";
constexpr const char* kPageFolder = "review";
constexpr const char* kProgramFiles[] = {"review.js", "review.css"};
constexpr const char* kTableFile = "reactions.js";
constexpr const char* kManifestKey = "manifest_sha256";
constexpr const char* kAheadFolder = ".ukemi/page";  // parts made before the page
constexpr std::size_t kLongestReadableName = 60;

/// What became of one source.
struct Made {
  std::optional<ReviewClip> clip;  // without its long texts, which are written
  std::string clip_file, character_file, thumbnail_light, thumbnail_dark;
  std::string error;
  Diagnostics diagnostics;
};

std::string character_path_of(const Made& made) { return "characters/" + made.character_file + ".js"; }
std::string clip_path_of(const Made& made) { return "clips/" + made.clip_file + ".js"; }

/// A name that is a file name everywhere and needs no escaping in an address.
std::string readable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (plain)
      result += c;
    else if (!result.ends_with('-'))
      result += '-';
  }
  return result.substr(0, kLongestReadableName);
}

/// A script that hands `json` to the page under a key.
std::string script(std::string_view kind, const std::string& key, const std::string& json) {
  return fmt::format("ukemi.register(\"{}\",\"{}\",{});\n", kind, key, json);
}

/// The page's folder, and the files that this page put into it.
class PageFolder {
 public:
  /// `shared`: other processes write the same bytes, so a file that exists is left as it is.
  explicit PageFolder(fs::path folder, bool shared = false) : folder_(std::move(folder)), shared_(shared) {}

  /// Errors: output.
  Status make() {
    std::error_code error;
    for (const char* below : {"clips", "characters", "thumbnails"}) {
      fs::create_directories(folder_ / below, error);
      if (error)
        return output_error(folder_ / below, "cannot make the folder: " + error.message(),
                            "check the folder's permissions");
    }
    return Done{};
  }

  /// Writes a file once; from any thread.
  template <typename Content>
  Status write(const std::string& relative, const Content& content) {
    {
      const std::lock_guard lock(mutex_);
      if (!written_.insert(relative).second) return Done{};
    }
    return write_file(folder_ / relative, content);
  }

  /// Whether this page has the file; from any thread.
  bool has(const std::string& relative) {
    std::error_code error;
    const std::lock_guard lock(mutex_);
    return written_.contains(relative) || (shared_ && fs::exists(folder_ / relative, error));
  }

  /// Takes over a file that lies in the folder already, or comes from another one of the same disk.
  bool take(const std::string& relative, const fs::path& from) {
    std::error_code error;
    fs::rename(from / relative, folder_ / relative, error);
    const std::lock_guard lock(mutex_);
    if (!error) written_.insert(relative);
    return written_.contains(relative);
  }

  /// Removes what an earlier page left and this one does not use.
  void remove_leftovers() const {
    std::error_code error;
    for (const char* below : {"clips", "characters", "thumbnails"})
      for (const auto& entry : fs::directory_iterator(folder_ / below, error))
        if (!written_.contains(std::string(below) + "/" + entry.path().filename().string()))
          fs::remove(entry.path(), error);
  }

 private:
  fs::path folder_;
  bool shared_;
  std::mutex mutex_;
  std::set<std::string> written_;
};

/// Whether index.html and the page's folder are free or ours. Errors: output.
Status check_ours(const fs::path& folder) {
  const fs::path page = folder / "index.html";
  std::error_code error;
  if (fs::exists(page, error)) {
    const auto bytes = read_file(page, kMaxAssetBytes);
    const std::string text = bytes ? std::string(bytes->begin(), bytes->end()) : "";
    if (text.find(kMarkOfOurPage) == std::string::npos)
      return output_error(page, "is not a page of this program and would be lost", "move it away");
  } else if (fs::exists(folder / kPageFolder, error) &&
             !fs::exists(folder / kPageFolder / "review.js", error)) {
    return output_error(folder / kPageFolder, "is not a folder of this program", "move it away");
  }
  return Done{};
}

Result<std::string> read_asset(const std::string& name) {
  const auto path = find_asset("web/" + name);
  if (!path) return path.error();
  const auto bytes = read_file(*path, kMaxAssetBytes);
  if (!bytes) return bytes.error();
  return std::string(bytes->begin(), bytes->end());
}

std::string_view text_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Writes a clip's files. Errors: output.
Status write_clip(const ReviewSource& source, PageFolder& page, Made& made) {
  ReviewClip& clip = *made.clip;
  made.character_file = fmt::format("{}-{}", readable(source.character), clip.mesh->hash);
  const std::string json =
      fmt::format("{{\"character\":\"{}\",{}", made.character_file, clip.clip_json.substr(1));
  const std::string stem = readable(source.character + "-" + source.name);
  made.clip_file = fmt::format("{}-{}", stem, content_hash(json));
  const std::string character_file = character_path_of(made);
  if (!page.has(character_file))
    if (Status status = page.write(character_file, script("character", made.character_file, clip.mesh->json));
        !status)
      return status;
  if (Status status = page.write(clip_path_of(made), script("clip", made.clip_file, json)); !status)
    return status;
  made.thumbnail_light = "thumbnails/" + stem + "-" + content_hash(text_of(clip.thumbnail_light)) + ".webp";
  made.thumbnail_dark = "thumbnails/" + stem + "-" + content_hash(text_of(clip.thumbnail_dark)) + ".webp";
  if (Status status = page.write(made.thumbnail_light, clip.thumbnail_light); !status) return status;
  if (Status status = page.write(made.thumbnail_dark, clip.thumbnail_dark); !status) return status;
  clip.clip_json.clear();
  clip.mesh.reset();
  clip.thumbnail_light.clear();
  clip.thumbnail_dark.clear();
  return Done{};
}

// ---- parts made ahead

fs::path ahead_folder(const fs::path& folder) { return folder / kAheadFolder; }

fs::path ahead_file(const fs::path& folder, const ReviewSource& source) {
  return ahead_folder(folder) / (readable(source.character + "-" + source.name) + "-" +
                                 content_hash(source.character + "/" + source.name) + ".json");
}

/// Of what a part is made from; "" where the clip cannot be read.
std::string inputs_of(const fs::path& folder, const ReviewSource& source) {
  Digest digest;
  digest.add_field(build_id());
  for (const fs::path& path : {source.clip, source.report}) {
    digest.add_field(path.generic_string());
    if (path.empty()) continue;
    const auto bytes = read_file(folder / path, kMaxTableBytes);
    if (!bytes) return "";
    digest.add(*bytes);
  }
  return digest.hex();
}

std::string part_text(const std::string& inputs, const Made& made) {
  Json json{{"inputs", inputs},
            {"clip", made.clip_file},
            {"character", made.character_file},
            {"light", made.thumbnail_light},
            {"dark", made.thumbnail_dark},
            {"duration_s", made.clip->duration_s},
            {"travel_m", made.clip->travel_m},
            {"excess_max_deg", made.clip->clip_excess_max_deg},
            {"warnings", Json::array()}};
  for (const Warning& warning : made.diagnostics.warnings())
    json["warnings"].push_back({warning.subject, warning.what});
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

/// The part that make_review_part kept; nothing where it belongs to other inputs.
std::optional<Made> part_in(const fs::path& file, const std::string& inputs) {
  const auto bytes = read_file(file, kMaxAssetBytes);
  const Json json = bytes ? Json::parse(*bytes, nullptr, false) : Json();
  if (!json.is_object() || inputs.empty() || json.value("inputs", "") != inputs) return std::nullopt;
  try {
    Made made;
    made.clip_file = json.at("clip");
    made.character_file = json.at("character");
    made.thumbnail_light = json.at("light");
    made.thumbnail_dark = json.at("dark");
    made.clip.emplace();
    made.clip->duration_s = json.at("duration_s");
    made.clip->travel_m = json.at("travel_m");
    made.clip->clip_excess_max_deg = json.at("excess_max_deg");
    for (const Json& warning : json.at("warnings")) made.diagnostics.warn(warning.at(0), warning.at(1));
    return made;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

/// Moves a part that was made ahead into the page. False where there is none that fits.
bool take_part(const fs::path& folder, const ReviewSource& source, PageFolder& page, Made& made) {
  const fs::path file = ahead_file(folder, source);
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  auto part = part_in(file, inputs_of(folder, source));
  if (!part) return false;
  for (const std::string& name :
       {character_path_of(*part), clip_path_of(*part), part->thumbnail_light, part->thumbnail_dark})
    if (!page.take(name, ahead_folder(folder))) return false;
  made = std::move(*part);
  return true;
}

/// Loads and writes one reaction; a clip that cannot be read is not an error of the page. Errors: output.
Status make_one(const fs::path& folder, const ReviewSource& source, PageFolder& page, Made& made) {
  if (source.clip.empty() || source.status == "failed") return Done{};
  if (take_part(folder, source, page, made)) return Done{};
  auto clip = review_clip(folder, source, made.diagnostics);
  if (!clip) {
    if (clip.error().kind == ErrorKind::output) return clip.error();
    made.error = clip.error().what;
    made.diagnostics.warn(source.clip.string(), clip.error().what + "; it is listed without its clip");
    return Done{};
  }
  made.clip = std::move(*clip);
  return write_clip(source, page, made);
}

/// Runs make_one on every source. Errors: those of make_one; an exception names the clip.
Status make_all(const fs::path& folder, const std::vector<ReviewSource>& sources, PageFolder& page,
                const ReviewSettings& settings, const std::function<void(int, int)>& progress,
                std::vector<Made>& made) {
  const auto work = [&](std::size_t i) -> Status {
    Status status = without_exceptions([&] { return make_one(folder, sources[i], page, made[i]); });
    if (status || !status.error().file.empty()) return status;
    Error error = status.error();
    error.file = (folder / sources[i].clip).string();
    return error;
  };
  return for_each_parallel(sources.size(), settings.threads, work, [&](int done) {
    if (progress) progress(done, static_cast<int>(sources.size()));
  });
}

/// As a link from the page: each part of the path escaped by the page itself.
Json link(const fs::path& path) { return text_or_null<Json>(path.generic_string()); }

Json reaction_json(const ReviewSource& source, const Made& made) {
  Json figures = Json::parse(source.figures_json);
  if (made.clip) {
    const auto fill = [&](const char* key, double value) {
      if (!figures.contains(key) || figures[key].is_null()) figures[key] = value;
    };
    fill("duration_s", made.clip->duration_s);
    fill("travel_m", made.clip->travel_m);
    figures["clip_excess_max_deg"] = made.clip->clip_excess_max_deg;
  }
  Json json;
  json["character"] = source.character;
  json["name"] = source.name;
  json["status"] = made.error.empty() ? source.status : "unreadable";
  json["error"] = text_or_null<Json>(made.error.empty() ? source.error : made.error);
  json["settings"] = Json::parse(source.settings_json);
  json["figures"] = std::move(figures);
  json["digest"] = text_or_null<Json>(source.digest);
  json["warnings"] = source.warnings;
  json["outputs"] = source.outputs;
  json["report"] = link(source.report);
  json["sheet"] = link(source.sheet);
  json["clip"] = text_or_null<Json>(made.clip_file);
  json["mesh"] = text_or_null<Json>(made.character_file);
  json["thumbnail"] = text_or_null<Json>(made.thumbnail_light);
  json["thumbnail_dark"] = text_or_null<Json>(made.thumbnail_dark);
  return json;
}

std::string table_json(const ReviewSources& sources, const std::vector<Made>& made,
                       const std::string& manifest) {
  Json json;
  json["format"] = 1;
  json["generator"] = generator();
  json[kManifestKey] = text_or_null<Json>(manifest);
  json["recipe"] = text_or_null<Json>(sources.recipe);
  json["reactions"] = Json::array();
  for (std::size_t i = 0; i < made.size(); ++i)
    json["reactions"].push_back(reaction_json(sources.reactions[i], made[i]));
  return script_safe(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

/// What every page has. Errors: output, input (assets).
Status write_program(PageFolder& page) {
  for (const char* file : kProgramFiles) {
    const auto text = read_asset(file);
    if (!text) return text.error();
    if (Status status = page.write(file, *text); !status) return status;
  }
  return Done{};
}

/// The page itself, last, so that it never shows half a table. Errors: output, input (assets).
Status write_page(const fs::path& folder, PageFolder& page, const ReviewSources& sources,
                  const std::vector<Made>& made) {
  if (Status status = write_program(page); !status) return status;
  const std::string table = table_json(sources, made, manifest_digest(folder));
  if (Status status = page.write(kTableFile, script("reactions", "all", table)); !status) return status;
  auto html = read_asset("index.html");
  if (!html) return html.error();
  return write_file(folder / "index.html", *html);
}

Review counted(const fs::path& folder, const std::vector<Made>& made) {
  Review review{(folder / "index.html").lexically_normal(), static_cast<int>(made.size()), 0, 0};
  std::set<std::string> characters;
  for (const Made& one : made) {
    if (!one.clip) continue;
    ++review.clips;
    characters.insert(one.character_file);
  }
  review.characters = static_cast<int>(characters.size());
  return review;
}

std::string text_of_file(const fs::path& path) {
  const auto bytes = read_file(path, kMaxTableBytes);
  return bytes ? std::string(text_of(*bytes)) : std::string();
}

bool is_our_program(const fs::path& page) {
  for (const char* file : kProgramFiles)
    if (const auto ours = read_asset(file);
        !ours || text_of_file(page.parent_path() / kPageFolder / file) != *ours)
      return false;
  const auto html = read_asset("index.html");
  return html && text_of_file(page) == *html;
}

}  // namespace

bool review_is_current(const fs::path& folder) {
  const fs::path page = folder / "index.html";
  const std::string manifest = manifest_digest(folder);
  const std::string table = text_of_file(folder / kPageFolder / kTableFile);
  if (manifest.empty() || table.find(fmt::format("\"{}\":\"{}\"", kManifestKey, manifest)) == table.npos)
    return false;
  Diagnostics unheard;
  const auto sources = review_sources(folder, unheard);
  if (!sources || !is_our_program(page)) return false;
  std::error_code error;
  const auto made = fs::last_write_time(page, error);
  const auto is_newer = [&](const fs::path& file) {
    return !file.empty() && (fs::last_write_time(folder / file, error) > made || error);
  };
  return !error &&
         std::none_of(sources->reactions.begin(), sources->reactions.end(),
                      [&](const auto& source) { return is_newer(source.clip) || is_newer(source.report); });
}

Status make_review_part(const fs::path& folder, const ReviewPart& part) {
  ReviewSource source;
  source.character = part.character;
  source.name = part.name;
  source.clip = clip_among(part.outputs);
  source.report = part.report;
  PageFolder page(ahead_folder(folder), true);
  if (const Status status = page.make(); !status) return status;
  return without_exceptions([&]() -> Status {
    Made made;
    if (const Status status = make_one(folder, source, page, made); !status || !made.clip) return status;
    return write_file(ahead_file(folder, source), part_text(inputs_of(folder, source), made));
  });
}

Result<Review> write_review(const fs::path& folder, const ReviewSettings& settings, Diagnostics& diagnostics,
                            const std::function<void(int, int)>& progress) {
  const auto sources = review_sources(folder, diagnostics);
  if (!sources) return sources.error();
  if (const Status status = check_ours(folder); !status) return status.error();
  const fs::path page_folder = folder / kPageFolder;
  std::error_code error;
  const bool is_new = !fs::exists(page_folder, error);
  PageFolder page(page_folder);
  std::vector<Made> made(sources->reactions.size());
  Status status = page.make();
  if (status && is_new) status = write_program(page);  // a page that is cut short is known as ours
  if (status) status = make_all(folder, sources->reactions, page, settings, progress, made);
  if (status) status = write_page(folder, page, *sources, made);
  if (!status) {
    if (is_new) fs::remove_all(page_folder, error);
    return status.error();
  }
  page.remove_leftovers();
  fs::remove_all(ahead_folder(folder), error);
  for (const Made& one : made)
    for (const Warning& warning : one.diagnostics.warnings()) diagnostics.warn(warning.subject, warning.what);
  return counted(folder, made);
}

}  // namespace ukemi
