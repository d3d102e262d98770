#include "render/offscreen.h"

#include <dlfcn.h>

#include <cstdlib>
#include <string_view>

#include "base/errors.h"

namespace ukemi {

// Never closed: Mesa leaves thread-local destructors behind that must outlive the library's users.
SharedLibrary::SharedLibrary(const char* name) : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {}
SharedLibrary::~SharedLibrary() = default;

void* SharedLibrary::find(const char* symbol) const { return handle_ ? dlsym(handle_, symbol) : nullptr; }

namespace {

/// The kind that the environment asks for, where the caller asks for none.
Result<OffscreenKind> in_force(OffscreenKind asked) {
  const char* value = std::getenv("UKEMI_OFFSCREEN");
  if (asked != OffscreenKind::any || value == nullptr || *value == '\0') return asked;
  const std::string_view word = value;
  if (word == "osmesa") return OffscreenKind::osmesa;
  if (word == "egl") return OffscreenKind::egl;
  return usage_error("UKEMI_OFFSCREEN is '" + std::string(word) + "'",
                     "set it to osmesa or egl, or not at all");
}

}  // namespace

Result<std::unique_ptr<Offscreen>> make_offscreen(OffscreenKind asked) {
  const auto chosen = in_force(asked);
  if (!chosen) return chosen.error();
  const OffscreenKind kind = *chosen;
  std::string osmesa_reason;
  std::string egl_reason;
  if (kind != OffscreenKind::egl)
    if (auto context = make_osmesa(osmesa_reason)) return context;
  if (kind != OffscreenKind::osmesa)
    if (auto context = make_egl(egl_reason)) return context;
  const std::string both = osmesa_reason.empty() || egl_reason.empty() ? "" : "; ";
  return output_error({}, "cannot draw off-screen: " + osmesa_reason + both + egl_reason,
                      "install libosmesa6 (or libegl1 with libegl-mesa0), or leave the picture out");
}

}  // namespace ukemi
