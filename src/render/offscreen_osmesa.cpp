#include <array>

#include "render/offscreen.h"

namespace ukemi {
namespace {

// From GL/osmesa.h, which would bring GL/gl.h, which excludes GL/glcorearb.h.
using OSMesaContext = struct OsmesaOpaque*;
constexpr int OSMESA_RGBA = GL_RGBA;
constexpr int OSMESA_FORMAT = 0x22;
constexpr int OSMESA_DEPTH_BITS = 0x30;
constexpr int OSMESA_PROFILE = 0x33;
constexpr int OSMESA_CORE_PROFILE = 0x34;
constexpr int OSMESA_CONTEXT_MAJOR_VERSION = 0x36;
constexpr int OSMESA_CONTEXT_MINOR_VERSION = 0x37;

using CreateContext = OSMesaContext (*)(const int*, OSMesaContext);
using MakeCurrent = GLboolean (*)(OSMesaContext, void*, GLenum, GLsizei, GLsizei);
using DestroyContext = void (*)(OSMesaContext);
using GetProcAddress = void (*(*)(const char*))();

class OsmesaContext : public Offscreen {
 public:
  ~OsmesaContext() override {
    if (context_ != nullptr) destroy_(context_);
  }

  bool open(std::string& reason) {
    CreateContext create = nullptr;
    MakeCurrent make_current = nullptr;
    GetProcAddress get_proc_address = nullptr;
    if (!library_ || !library_.find("OSMesaCreateContextAttribs", create) ||
        !library_.find("OSMesaMakeCurrent", make_current) ||
        !library_.find("OSMesaDestroyContext", destroy_) ||
        !library_.find("OSMesaGetProcAddress", get_proc_address)) {
      reason = "libOSMesa.so.8 is missing";
      return false;
    }
    const std::array attributes{OSMESA_FORMAT,
                                OSMESA_RGBA,
                                OSMESA_DEPTH_BITS,
                                0,
                                OSMESA_PROFILE,
                                OSMESA_CORE_PROFILE,
                                OSMESA_CONTEXT_MAJOR_VERSION,
                                3,
                                OSMESA_CONTEXT_MINOR_VERSION,
                                3,
                                0};
    context_ = create(attributes.data(), nullptr);
    if (context_ == nullptr || !make_current(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) ||
        !gl_.load([&](const char* name) { return reinterpret_cast<void*>(get_proc_address(name)); })) {
      reason = "libOSMesa.so.8 has no OpenGL 3.3";
      return false;
    }
    return true;
  }

 private:
  SharedLibrary library_{"libOSMesa.so.8"};
  DestroyContext destroy_ = nullptr;
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4> pixel_{};
};

}  // namespace

std::unique_ptr<Offscreen> make_osmesa(std::string& reason) {
  auto context = std::make_unique<OsmesaContext>();
  if (!context->open(reason)) return nullptr;
  return context;
}

}  // namespace ukemi
