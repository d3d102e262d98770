// The keys under which a report holds the values that other pages show: one table for everything that
// reads reports. tests/bake compares it with written reports.
#pragma once

namespace ukemi {

struct ReportKey {
  const char* shown;    // its name in a manifest and on the review page
  const char* section;  // of the report
  const char* key;      // in the section
};

inline constexpr ReportKey kReportSettings[] = {
    {"hit", "impact", "segment"},
    {"from", "impact", "from"},
    {"preset", "impact", "preset"},
    {"scene", "impact", "scene"},
    {"pose", "settings", "pose"},
    {"clip", "settings", "clip"},
    {"at_s", "settings", "at_s"},
    {"region", "settings", "region"},
    {"limits", "settings", "limits"},
    {"active", "settings", "active"},
    {"tone", "settings", "tone"},
    {"rate", "settings", "rate"},
    {"fps", "settings", "fps"},
    {"seed", "settings", "seed"},
    {"get_up_clip", "settings", "get_up_clip"},
};

inline constexpr ReportKey kReportFigures[] = {
    {"excess_max_deg", "limits", "excess_max_deg"},
    {"excess_p999_deg", "limits", "excess_p999_deg"},
    {"over_1deg", "limits", "over_1deg"},
    {"samples", "limits", "samples"},
    {"worst_joint", "limits", "worst_joint"},
    {"momentum_n_s", "impact", "momentum_n_s"},
    {"rest_time_s", "simulation", "rest_time_s"},
    {"joint_separation_max_m", "simulation", "joint_separation_max_m"},
    {"energy_gain_max_j", "simulation", "energy_gain_max_j"},
    {"floor_penetration_max_m", "simulation", "floor_penetration_max_m"},
    {"self_penetration_max_m", "simulation", "self_penetration_max_m"},
    {"outcome", "response", "outcome"},
    {"end_pose", "response", "end_pose"},
    {"score", "response", "score"},
    {"steps", "response", "steps"},
    {"duration_s", "clip", "duration_s"},
    {"frames", "clip", "frames"},
    {"keys", "clip", "keys"},
};

}  // namespace ukemi
