#include "base/errors.h"

namespace ukemi {

Error usage_error(std::string what, std::string fix) {
  return usage_error({}, std::move(what), std::move(fix));
}

Error usage_error(const std::filesystem::path& file, std::string what, std::string fix) {
  return {ErrorKind::usage, file.string(), 0, 0, "", std::move(what), std::move(fix)};
}

Error input_error(const std::filesystem::path& file, std::string what, std::string fix) {
  return {ErrorKind::input, file.string(), 0, 0, "", std::move(what), std::move(fix)};
}

Error output_error(const std::filesystem::path& file, std::string what, std::string fix) {
  return {ErrorKind::output, file.string(), 0, 0, "", std::move(what), std::move(fix)};
}

Error simulation_error(std::string what, std::string fix) {
  return {ErrorKind::simulation, "", 0, 0, "", std::move(what), std::move(fix)};
}

Error internal_error(std::string what, std::string fix) {
  return {ErrorKind::internal, "", 0, 0, "", std::move(what), std::move(fix)};
}

Error error_about(std::string joint, Error error) {
  error.joint = std::move(joint);
  return error;
}

}  // namespace ukemi
