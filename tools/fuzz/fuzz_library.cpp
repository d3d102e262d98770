// Lines of a batch's journal, and the library tables of those that are records.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/library.h"
#include "bake/record.h"
#include "fuzz/checks.h"

namespace {

using namespace ukemi;

/// Fields of every line of a table as RFC 4180 has them. Refuses quotes that are none.
std::vector<std::size_t> widths(const std::string& csv) {
  std::vector<std::size_t> lines;
  std::size_t fields = 1;
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    if (csv[i] == '"') quoted = !quoted;
    if (quoted) continue;
    if (csv[i] == ',') ++fields;
    if (csv[i] != '\n') continue;
    fuzz::require(i > 0 && csv[i - 1] == '\r', "lines end with CR LF");
    lines.push_back(fields);
    fields = 1;
  }
  fuzz::require(!quoted && fields == 1, "the last line ends, and so does every quote");
  return lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto record = parse_record(fuzz::text_of(data, size));
  if (!record) return 0;
  const std::string line = record_line(*record);
  fuzz::require(line.find('\n') == std::string::npos, "a record is one line");
  const auto again = parse_record(line);
  fuzz::require(again && record_line(*again) == line, "what was written can be read");
  if (!record->done()) return 0;
  const std::vector<LibraryEntry> entries = {{record->library, ""}, {record->library, "accepted"}};
  const auto rows = nlohmann::json::parse(library_json(entries), nullptr, false);
  fuzz::require(rows.is_array() && rows.size() == 2, "the library has a row for each");
  fuzz::require(rows[0]["Name"] != rows[1]["Name"], "no name comes twice");
  const std::vector<std::size_t> lines = widths(library_csv(entries));
  fuzz::require(lines.size() == 3 && lines[0] == lines[1] && lines[1] == lines[2],
                "the table has titles and as many fields in every line");
  return 0;
}
