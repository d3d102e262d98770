// What is no ordinary file.
#include "load/load.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

namespace ukemi {
namespace {

namespace fs = std::filesystem;

class Load : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/ukemi_load_XXXXXX";
    folder = mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder); }

  std::string refusal(const fs::path& path, const LoadOptions& options = {}) {
    Diagnostics diagnostics;
    const auto character = load_character(path, options, diagnostics);
    EXPECT_FALSE(character) << path;
    if (character) return "";
    EXPECT_EQ(character.error().kind, ErrorKind::input);
    EXPECT_EQ(character.error().file, path.string());
    EXPECT_FALSE(character.error().fix.empty());
    return character.error().what;
  }

  fs::path folder;
};

TEST_F(Load, RefusesWhatIsNoRegularFileAtOnce) {
  for (const char* extension : {".glb", ".bvh", ".fbx", ".dae"}) {
    const fs::path at = folder / ("hero" + std::string(extension));
    EXPECT_NE(refusal(at).find("cannot read: No such file"), std::string::npos);
    fs::create_directory(at);
    EXPECT_EQ(refusal(at), "is a directory");
    fs::remove(at);
    ASSERT_EQ(mkfifo(at.c_str(), 0600), 0);
    EXPECT_EQ(refusal(at), "is not a regular file");
    fs::remove(at);
    for (const char* device : {"/dev/zero", "/dev/null"}) {
      fs::create_symlink(device, at);
      EXPECT_EQ(refusal(at), "is not a regular file");
      fs::remove(at);
    }
    fs::create_symlink(at.filename(), at);
    EXPECT_NE(refusal(at).find("cannot read: Too many levels of symbolic links"), std::string::npos);
    fs::remove(at);
    std::ofstream(at).close();
    EXPECT_EQ(refusal(at), "is empty");
  }
}

TEST_F(Load, FollowsSymbolicLinksToFiles) {
  const fs::path target = fs::path(UKEMI_ASSETS_FOLDER) / "characters" / "mannequin.glb";
  fs::create_symlink(target, folder / "hero.glb");
  fs::create_symlink("hero.glb", folder / "again.glb");
  Diagnostics diagnostics;
  EXPECT_TRUE(load_character(folder / "again.glb", {}, diagnostics));
}

TEST_F(Load, RefusesFilesThatMayNotBeRead) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const fs::path at = folder / "hero.glb";
  std::ofstream(at) << "glTF";
  fs::permissions(at, fs::perms::none);
  EXPECT_EQ(refusal(at), "cannot read: Permission denied");
}

TEST_F(Load, RefusesFilesBeyondTheLimitWithoutReadingThem) {
  const fs::path at = folder / "hero.fbx";
  std::ofstream(at).close();
  fs::resize_file(at, std::uintmax_t{40} << 30);  // sparse
  EXPECT_EQ(refusal(at), "has 42949672960 bytes; the limit is 536870912");
  LoadOptions options;
  options.max_file_bytes = 100;
  fs::resize_file(at, 101);
  EXPECT_EQ(refusal(at, options), "has 101 bytes; the limit is 100");
}

TEST_F(Load, RefusesNoiseOfEveryKind) {
  for (const char* extension : {".glb", ".gltf", ".vrm", ".bvh", ".fbx", ".dae", ".obj", ".x"}) {
    const fs::path at = folder / ("noise" + std::string(extension));
    std::ofstream file(at, std::ios::binary);
    std::uint32_t state = 1;
    for (int i = 0; i < 10000; ++i)
      file.put(static_cast<char>((state = state * 1664525u + 1013904223u) >> 24));
    file.close();
    Diagnostics diagnostics;
    const auto character = load_character(at, {}, diagnostics);
    EXPECT_TRUE(!character || character->parts.empty()) << at;
  }
}

}  // namespace
}  // namespace ukemi
