#include <GL/glcorearb.h>

#include "render/gl.h"

namespace ukemi {

bool Gl::load(const Offscreen& context) {
  bool complete = true;
#define UKEMI_GL_LOAD(name, upper)                                                \
  name = reinterpret_cast<PFNGL##upper##PROC>(context.find_function("gl" #name)); \
  complete = complete && name != nullptr;
  UKEMI_GL_FUNCTIONS(UKEMI_GL_LOAD)
#undef UKEMI_GL_LOAD
  return complete;
}

}  // namespace ukemi
