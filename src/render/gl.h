// The OpenGL functions that the painter calls, found at run time: the same table serves OSMesa and EGL.
// Headers of other projects are included by .cpp files alone: include <GL/glcorearb.h> first.
#pragma once

#ifndef __gl_glcorearb_h_
#error "include <GL/glcorearb.h> before this header"
#endif

#include "render/offscreen.h"

#define UKEMI_GL_FUNCTIONS(X)                                       \
  X(ActiveTexture, ACTIVETEXTURE)                                   \
  X(AttachShader, ATTACHSHADER)                                     \
  X(BindBuffer, BINDBUFFER)                                         \
  X(BindFramebuffer, BINDFRAMEBUFFER)                               \
  X(BindRenderbuffer, BINDRENDERBUFFER)                             \
  X(BindTexture, BINDTEXTURE)                                       \
  X(BindVertexArray, BINDVERTEXARRAY)                               \
  X(BlendEquation, BLENDEQUATION)                                   \
  X(BlendFunc, BLENDFUNC)                                           \
  X(BlitFramebuffer, BLITFRAMEBUFFER)                               \
  X(BufferData, BUFFERDATA)                                         \
  X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)                 \
  X(Clear, CLEAR)                                                   \
  X(ClearColor, CLEARCOLOR)                                         \
  X(ColorMask, COLORMASK)                                           \
  X(CompileShader, COMPILESHADER)                                   \
  X(CreateProgram, CREATEPROGRAM)                                   \
  X(CreateShader, CREATESHADER)                                     \
  X(DeleteShader, DELETESHADER)                                     \
  X(DeleteTextures, DELETETEXTURES)                                 \
  X(DepthMask, DEPTHMASK)                                           \
  X(DepthFunc, DEPTHFUNC)                                           \
  X(Disable, DISABLE)                                               \
  X(DrawArrays, DRAWARRAYS)                                         \
  X(DrawElements, DRAWELEMENTS)                                     \
  X(Enable, ENABLE)                                                 \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)               \
  X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)               \
  X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                     \
  X(FrontFace, FRONTFACE)                                           \
  X(GenBuffers, GENBUFFERS)                                         \
  X(GenFramebuffers, GENFRAMEBUFFERS)                               \
  X(GenRenderbuffers, GENRENDERBUFFERS)                             \
  X(GenTextures, GENTEXTURES)                                       \
  X(GenVertexArrays, GENVERTEXARRAYS)                               \
  X(GenerateMipmap, GENERATEMIPMAP)                                 \
  X(GetError, GETERROR)                                             \
  X(GetIntegerv, GETINTEGERV)                                       \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)                           \
  X(GetProgramiv, GETPROGRAMIV)                                     \
  X(GetUniformLocation, GETUNIFORMLOCATION)                         \
  X(LinkProgram, LINKPROGRAM)                                       \
  X(PixelStorei, PIXELSTOREI)                                       \
  X(PolygonOffset, POLYGONOFFSET)                                   \
  X(ReadPixels, READPIXELS)                                         \
  X(RenderbufferStorageMultisample, RENDERBUFFERSTORAGEMULTISAMPLE) \
  X(ShaderSource, SHADERSOURCE)                                     \
  X(TexImage2D, TEXIMAGE2D)                                         \
  X(TexParameteri, TEXPARAMETERI)                                   \
  X(Uniform1f, UNIFORM1F)                                           \
  X(Uniform1i, UNIFORM1I)                                           \
  X(Uniform3f, UNIFORM3F)                                           \
  X(Uniform4f, UNIFORM4F)                                           \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV)                             \
  X(UseProgram, USEPROGRAM)                                         \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER)                       \
  X(Viewport, VIEWPORT)

namespace ukemi {

struct Gl {
#define UKEMI_GL_MEMBER(name, upper) PFNGL##upper##PROC name = nullptr;
  UKEMI_GL_FUNCTIONS(UKEMI_GL_MEMBER)
#undef UKEMI_GL_MEMBER

  /// Fills the table; false when the context lacks a function.
  [[nodiscard]] bool load(const Offscreen& context);
};

}  // namespace ukemi
