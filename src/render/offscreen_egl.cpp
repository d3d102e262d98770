#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "render/offscreen.h"

namespace ukemi {
namespace {

struct Egl {
  decltype(&eglGetProcAddress) get_proc_address = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglBindAPI) bind_api = nullptr;
  decltype(&eglCreateContext) create_context = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  decltype(&eglDestroyContext) destroy_context = nullptr;

  bool load(const SharedLibrary& library) {
    return library && library.find("eglGetProcAddress", get_proc_address) &&
           library.find("eglInitialize", initialize) && library.find("eglBindAPI", bind_api) &&
           library.find("eglCreateContext", create_context) && library.find("eglMakeCurrent", make_current) &&
           library.find("eglDestroyContext", destroy_context);
  }
};

class EglContext : public Offscreen {
 public:
  // The display stays initialized: it is one for the whole process.
  ~EglContext() override {
    if (context_ == EGL_NO_CONTEXT) return;
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl_.destroy_context(display_, context_);
  }

  bool open(std::string& reason) {
    if (!egl_.load(library_)) {
      reason = "libEGL.so.1 is missing";
      return false;
    }
    if (!open_display() || !create_context()) {
      reason = "libEGL.so.1 has no OpenGL 3.3 without a surface";
      return false;
    }
    return true;
  }

  void* find_function(const char* name) const override {
    return reinterpret_cast<void*>(egl_.get_proc_address(name));
  }
  OffscreenKind kind() const override { return OffscreenKind::egl; }

 private:
  bool open_display() {
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl_.get_proc_address("eglGetPlatformDisplayEXT"));
    if (get_display == nullptr) return false;
    display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    return display_ != EGL_NO_DISPLAY && egl_.initialize(display_, nullptr, nullptr) &&
           egl_.bind_api(EGL_OPENGL_API);
  }

  bool create_context() {
    const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           3,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           3,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
    context_ = egl_.create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    return context_ != EGL_NO_CONTEXT &&
           egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }

  SharedLibrary library_{"libEGL.so.1"};
  Egl egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Offscreen> make_egl(std::string& reason) {
  auto context = std::make_unique<EglContext>();
  if (!context->open(reason)) return nullptr;
  return context;
}

}  // namespace ukemi
