// An OpenGL 3.3 core context without a window: OSMesa, or EGL without a surface where OSMesa is gone.
#pragma once

#include <memory>
#include <string>

#include "base/result.h"

namespace ukemi {

enum class OffscreenKind { any, osmesa, egl };

/// Current on the thread that made it, until it is destroyed. The default framebuffer is of no use: draw into
/// framebuffer objects.
class Offscreen {
 public:
  virtual ~Offscreen() = default;
  /// The OpenGL function of that name, or null.
  virtual void* find_function(const char* name) const = 0;
  /// osmesa or egl.
  virtual OffscreenKind kind() const = 0;
};

/// Any: what UKEMI_OFFSCREEN in the environment names (osmesa, egl), else OSMesa, then EGL. Errors: output,
/// with what each of them lacks; usage (another word in UKEMI_OFFSCREEN).
Result<std::unique_ptr<Offscreen>> make_offscreen(OffscreenKind kind = OffscreenKind::any);

/// Null, with the reason, when the library or the context is missing.
std::unique_ptr<Offscreen> make_osmesa(std::string& reason);
std::unique_ptr<Offscreen> make_egl(std::string& reason);

/// A shared library, open as long as this lives.
class SharedLibrary {
 public:
  explicit SharedLibrary(const char* name);
  ~SharedLibrary();
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;

  explicit operator bool() const { return handle_ != nullptr; }
  void* find(const char* symbol) const;
  template <typename Function>
  bool find(const char* symbol, Function& function) const {
    function = reinterpret_cast<Function>(find(symbol));
    return function != nullptr;
  }

 private:
  void* handle_;
};

}  // namespace ukemi
