// Runs a fuzzer's inputs without libFuzzer: files, and the files of folders.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "base/files.h"
#include "fuzz/checks.h"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(int count, char** words) {
  std::vector<fs::path> inputs;
  for (int i = 1; i < count; ++i) {
    if (!fs::is_directory(words[i])) {
      inputs.emplace_back(words[i]);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(words[i]))
      if (entry.is_regular_file()) inputs.push_back(entry.path());
  }
  std::sort(inputs.begin(), inputs.end());
  return inputs;
}

}  // namespace

int main(int count, char** words) {
  const std::vector<fs::path> inputs = inputs_of(count, words);
  for (const fs::path& input : inputs) {
    std::fprintf(stderr, "%s\n", input.c_str());  // the last one printed is the one that fails
    const auto bytes = ukemi::read_file(input, std::size_t{1} << 30);
    if (!bytes) return 2;
    LLVMFuzzerTestOneInput(bytes->data(), bytes->size());
  }
  std::printf("%zu inputs replayed\n", inputs.size());
  return inputs.empty() ? 2 : 0;
}
