#include <GL/osmesa.h>

#include <array>

#include "render/offscreen.h"

namespace ukemi {
namespace {

class OsmesaContext : public Offscreen {
 public:
  ~OsmesaContext() override {
    if (context_ != nullptr) destroy_(context_);
  }

  bool open(std::string& reason) {
    decltype(&OSMesaCreateContextAttribs) create = nullptr;
    decltype(&OSMesaMakeCurrent) make_current = nullptr;
    if (!library_ || !library_.find("OSMesaCreateContextAttribs", create) ||
        !library_.find("OSMesaMakeCurrent", make_current) ||
        !library_.find("OSMesaDestroyContext", destroy_) ||
        !library_.find("OSMesaGetProcAddress", get_proc_address_)) {
      reason = "libOSMesa.so.8 is missing";
      return false;
    }
    constexpr int kAttributes[] = {OSMESA_FORMAT,
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
    context_ = create(kAttributes, nullptr);
    if (context_ == nullptr || !make_current(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1)) {
      reason = "libOSMesa.so.8 has no OpenGL 3.3";
      return false;
    }
    return true;
  }

  void* find_function(const char* name) const override {
    return reinterpret_cast<void*>(get_proc_address_(name));
  }
  OffscreenKind kind() const override { return OffscreenKind::osmesa; }

 private:
  SharedLibrary library_{"libOSMesa.so.8"};
  decltype(&OSMesaDestroyContext) destroy_ = nullptr;
  decltype(&OSMesaGetProcAddress) get_proc_address_ = nullptr;
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
