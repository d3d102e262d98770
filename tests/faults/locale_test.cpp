// A host that has set a locale with a decimal comma: the same bytes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>

#include "bake/bake.h"
#include "base/files.h"

namespace ukemi {
namespace fs = std::filesystem;
namespace {

/// Numbers with a decimal comma and points between thousands, for C++ streams.
struct CommaNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// A locale made for the test: only its decimal point differs from POSIX. False where localedef cannot make
/// it.
bool set_comma_locale(const fs::path& folder) {
  std::ofstream(folder / "comma") << "LC_NUMERIC\ndecimal_point \"<U002C>\"\nthousands_sep \"<U002E>\"\n"
                                     "grouping 3;3\nEND LC_NUMERIC\n";
  const std::string command = "localedef --no-archive -c -i '" + (folder / "comma").string() + "' '" +
                              (folder / "xx_XX").string() + "' >/dev/null 2>&1";
  static_cast<void>(std::system(command.c_str()));
  setenv("LOCPATH", folder.c_str(), 1);
  return std::setlocale(LC_NUMERIC, "xx_XX") != nullptr ||
         std::setlocale(LC_NUMERIC, "de_DE.UTF-8") != nullptr;
}

/// Every output of a short bake, behind each other. Times of the stages are no part of it.
std::string bake_all(const fs::path& folder) {
  BakeSettings settings;
  settings.simulation.duration_s = 0.2;
  settings.outputs = {folder / "a.glb", folder / "a.gltf", folder / "a.bvh"};
  Diagnostics diagnostics;
  const auto baked = bake_file("mannequin", settings, diagnostics);
  EXPECT_TRUE(baked) << baked.error().message();
  std::string bytes;
  for (const fs::path& path : settings.outputs) {
    const auto content = read_file(path, std::size_t{1} << 28);
    EXPECT_TRUE(content);
    bytes.append(content->begin(), content->end());
  }
  bytes += baked->outcome.figures.hash;
  return bytes + baked->report.substr(0, baked->report.find("\"timings_s\""));
}

TEST(Locale, ADecimalCommaChangesNoByte) {
  std::string pattern = (fs::temp_directory_path() / "ukemi_locale_XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const std::string reference = bake_all(pattern);
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
  const bool comma = set_comma_locale(pattern);
  if (comma) {
    char text[16];
    std::snprintf(text, sizeof text, "%.1f", 1.5);
    EXPECT_STREQ(text, "1,5") << "the locale is in force";
  }
  EXPECT_EQ(bake_all(pattern), reference);
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
  fs::remove_all(pattern);
  if (!comma) GTEST_SKIP() << "no locale with a decimal comma can be made; C++ streams alone were tried";
}

}  // namespace
}  // namespace ukemi
