// What a bake leaves: a timeline and the figures of its simulation, then what is exported of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "clip/timeline.h"
#include "export/export.h"
#include "judge/clip_limits.h"
#include "judge/skin_on_floor.h"
#include "prepare/prepared.h"
#include "rise/getting_up.h"
#include "simulate/simulate.h"

namespace ukemi {

/// Wall-clock seconds.
struct BakeTimings {
  double load = 0, simulate = 0, resample = 0, export_ = 0, render = 0, total = 0;
};

/// A simulated reaction as a clip, before anything is written.
struct BakedClip {
  Prepared prepared;
  LimitFigures limits;
  SimulationFigures figures;
  ControllerReport behaviour;
  std::optional<GetUpTimes> get_up;
  Timeline timeline;               // its still tail trimmed, lead and recovery added
  SkinOnFloor skin;                // of the whole timeline
  ClipLimits human;                // of the whole timeline, against the human range
  double returns_s = 0.0;          // blend at the end, part of the timeline
  double ground_lift_max_m = 0.0;  // how far frames were raised so that the skin stays above the floor
  ResampleError resample_error;
  int trials = 1;      // of the search that found it
  double score = 0.0;  // how like a person the body moves, see score.h
  BakeTimings timings_s;
};

struct OutputFile {
  std::filesystem::path path;
  std::vector<std::uint8_t> bytes;
};

/// A baked clip with its files, and the report on it.
struct BakedFile {
  BakedClip outcome;
  ReducedClip reduced;
  ClipLimits written;             // its frames, against the range in force
  std::vector<Vec3> root_curve;   // see ExportedClip
  std::vector<OutputFile> files;  // clips and pictures
  std::string report;             // JSON, format 1
};

}  // namespace ukemi
