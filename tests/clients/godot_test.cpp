// The reader for Godot (tools/engines/godot) in Godot 3, headless: events and the row of the library.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "bake/bake.h"
#include "bake/library.h"
#include "base/files.h"
#include "load/load.h"
#include "support/command.h"

namespace ukemi {
namespace {

namespace fs = std::filesystem;

std::string godot() {
  for (const char* name : {"godot3-server", "godot3"})
    if (run_command(std::string("command -v ") + name).second == 0) return name;
  return "";
}

TEST(Godot, ImportsEventsAndTheRowOfTheLibrary) {
  const std::string program = godot();
  if (program.empty()) GTEST_SKIP() << "Godot 3 is not installed: apt-get install godot3-server";
  const fs::path project = fs::temp_directory_path() / fmt::format("ukemi_godot_{}", getpid());
  fs::create_directories(project / "hits");
  const fs::path given = fs::path(UKEMI_CLIENTS_FOLDER) / "godot";
  fs::copy_file(given / "project.godot", project / "project.godot");
  fs::copy_file(given / "check.gd", project / "check.gd");
  fs::copy_file(given / "hit.glb.import", project / "hits/hit.glb.import");
  fs::copy_file(fs::path(UKEMI_CLIENTS_FOLDER) / "../../tools/engines/godot/post_import.gd",
                project / "post_import.gd");
  Diagnostics diagnostics;
  const auto mannequin =
      load_character(fs::path(UKEMI_ASSETS_FOLDER) / "characters/mannequin.glb", {}, diagnostics);
  ASSERT_TRUE(mannequin);
  BakeSettings settings;
  settings.preset = "punch";
  settings.lead_s = 0.25;
  settings.outputs = {project / "hits/hit.glb"};
  settings.events = project / "hits/hit.events.json";
  auto baked = bake_loaded(*mannequin, settings, diagnostics);
  ASSERT_TRUE(baked) << baked.error().message();
  ASSERT_TRUE(write_files(*baked));
  settings.outputs = {"hits/hit.glb"};
  ASSERT_TRUE(write_file(project / "library.json", library_json({{library_row("m", settings, *baked), ""}})));

  run_command(
      fmt::format("HOME='{0}' timeout 120 {1} --path '{0}' --editor --quit", project.string(), program));
  const std::string out = run_command(fmt::format("HOME='{0}' timeout 120 {1} --path '{0}' -s check.gd",
                                                  project.string(), program))
                              .first;
  EXPECT_NE(out.find("row m_chest_front stepped standing\n"), std::string::npos) << out;
  EXPECT_NE(out.find("event 0.250 ukemi_event impact\n"), std::string::npos) << out;
  EXPECT_NE(out.find("loop "), std::string::npos) << out;
  fs::remove_all(project);
}

}  // namespace
}  // namespace ukemi
