#include "render/offscreen.h"

#include <dlfcn.h>

#include "base/errors.h"

namespace ukemi {

// Never closed: Mesa leaves thread-local destructors behind that must outlive the library's users.
SharedLibrary::SharedLibrary(const char* name) : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {}
SharedLibrary::~SharedLibrary() = default;

void* SharedLibrary::find(const char* symbol) const { return handle_ ? dlsym(handle_, symbol) : nullptr; }

Result<std::unique_ptr<Offscreen>> make_offscreen(OffscreenKind kind) {
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
