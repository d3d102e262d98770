// The review page over a folder of baked reactions: one static folder that any browser opens from disk.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/result.h"

namespace ukemi {

struct ReviewSettings {
  int threads = 2;
};

/// What the page holds.
struct Review {
  std::filesystem::path page;  // FOLDER/index.html
  int reactions = 0;           // listed
  int clips = 0;               // that can be played
  int characters = 0;          // meshes, each stored once
};

/// Writes FOLDER/index.html and FOLDER/review/: the page's program, a table of all reactions, and for each
/// clip, mesh and thumbnail a file that the page loads when it is needed. The reactions are those of
/// FOLDER/manifest.json; without a manifest every clip (.glb .gltf .bvh) below the folder, with the report
/// of the same name beside it where there is one. A clip that cannot be read is listed with its error and
/// warned of. The same folder gives the same bytes. `progress` may be empty; it is called from any thread,
/// one at a time.
/// Errors: input (no such folder, malformed manifest, nothing to review); output (cannot write, an
/// index.html or a folder "review" that is not ours).
Result<Review> write_review(const std::filesystem::path& folder, const ReviewSettings& settings,
                            Diagnostics& diagnostics,
                            const std::function<void(int done, int total)>& progress = {});

/// One reaction of a batch that is under way. Paths are relative to its folder.
struct ReviewPart {
  std::string character, name;  // as the manifest will say
  std::vector<std::string> outputs;
  std::filesystem::path report;  // "" where there is none
};

/// Makes ahead what write_review will need of a reaction whose files are written, and keeps it in
/// FOLDER/.ukemi/page: a batch's workers do so while others simulate. The page has the same bytes without it.
/// Errors: output.
Status make_review_part(const std::filesystem::path& folder, const ReviewPart& part);

/// Whether FOLDER has the page that write_review would make of its manifest now: made from the same manifest
/// by the same program, and no clip or report is newer than it.
bool review_is_current(const std::filesystem::path& folder);

}  // namespace ukemi
