#include "restrict/active.h"

#include <toml++/toml.h>

#include "base/errors.h"
#include "base/files.h"

namespace ukemi {
namespace {

constexpr std::size_t kMaxBytes = 1u << 20;

Error fail(const std::string& file, const toml::node& where, std::string joint, std::string what) {
  return error_at(where.source().begin,
                  error_about(std::move(joint),
                              input_error(file, std::move(what),
                                          "give [a_y, a_z, alpha] in degrees per second, each above 0")));
}

/// "knee" for knee_l and knee_r.
std::string_view side_free(std::string_view joint) {
  return joint.ends_with("_l") || joint.ends_with("_r") ? joint.substr(0, joint.size() - 2) : joint;
}

Result<ActiveThresholds> read(const toml::table& document, const std::string& file) {
  const toml::table* table = document["threshold"].as_table();
  if (table == nullptr) return fail(file, document, "", "has no [threshold] table");
  ActiveThresholds thresholds;
  for (int j = 0; j < kJointCount; ++j) {
    const std::string joint(side_free(name(joint_at(j))));
    const toml::node* node = table->get(joint);
    if (node == nullptr) return fail(file, *table, joint, "has no threshold");
    const toml::array* values = node->as_array();
    if (values == nullptr || values->size() != 3) return fail(file, *node, joint, "is not three numbers");
    for (int axis = 0; axis < 3; ++axis) {
      const double value = (*values)[axis].value_or<double>(0.0);
      if (!(value > 0.0)) return fail(file, *node, joint, "has a threshold that is not above 0");
      thresholds[j][axis] = radians(value);
    }
  }
  return thresholds;
}

}  // namespace

Result<ActiveThresholds> load_active_thresholds(const std::string& file) {
  std::filesystem::path path = file;
  if (file.empty()) {
    Result<std::filesystem::path> asset = find_asset("limits/active.toml");
    if (!asset) return asset.error();
    path = *asset;
  }
  Result<std::vector<std::uint8_t>> bytes = read_file(path, kMaxBytes);
  if (!bytes) return bytes.error();
  try {
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    return read(toml::parse(text, path.string()), path.string());
  } catch (const toml::parse_error& error) {
    return error_at(error.source().begin,
                    input_error(path, std::string(error.description()), "correct the TOML"));
  }
}

}  // namespace ukemi
