#include "render/painter.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/errors.h"
#include "render/gl.h"
#include "render/lighting.h"
#include "render/shaders.h"

namespace ukemi {
namespace {

constexpr int kSamples = 4;
constexpr int kLightMapSize = 1024;
constexpr int kFloorMapSize = 256;

/// Orthographic view from the key light that holds the bounds.
Eigen::Matrix4f light_from_world(const ShadowBounds& bounds, const Vec3& to_key) {
  const Eigen::Vector3d centre = 0.5 * (bounds.low + bounds.high).cast<double>();
  const double radius = 0.5 * (bounds.high - bounds.low).cast<double>().norm() + 0.05;
  const Quat turn = Quat::FromTwoVectors(to_key, Vec3::UnitZ());
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  Mat3 scale = Vec3(1.0 / radius, 1.0 / radius, -1.0 / radius).asDiagonal();
  matrix.topLeftCorner<3, 3>() = scale * turn.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = -(matrix.topLeftCorner<3, 3>() * centre);
  return matrix.cast<float>();
}

}  // namespace

struct Painter::State {
  std::unique_ptr<Offscreen> context;
  OffscreenKind asked;  // what kind of context
  Gl gl;
  int width, height;
  GLuint surface = 0, depth = 0, flat = 0, floor = 0;                        // programs
  GLuint multisampled = 0, resolved = 0, light_target = 0, flat_target = 0;  // framebuffers
  GLuint light_map = 0, flat_map = 0, shadow_map = 0, white = 0;             // textures
  GLuint vertex_array = 0, vertex_buffer = 0, index_buffer = 0;
  std::vector<GLuint> textures;
  std::string trouble;

  State(std::unique_ptr<Offscreen> offscreen, OffscreenKind wanted, int w, int h)
      : context(std::move(offscreen)), asked(wanted), width(w), height(h) {}

  // Set-up.
  void set_up();
  bool take_textures(const std::vector<Picture>& pictures);
  GLuint compile(GLenum kind, const char* source);
  GLuint link(const char* vertex, const char* fragment);
  GLuint texture(GLint format, int w, int h, GLenum layout, GLenum type, const void* pixels);
  GLuint framebuffer(GLenum attachment, GLuint texture);
  GLuint renderbuffer(GLenum format);
  GLuint upload(const Picture& picture);
  bool make_targets();
  void make_buffers();
  bool complete();

  // Drawing.
  GLint at(GLuint program, const char* name) const { return gl.GetUniformLocation(program, name); }
  void set(GLuint program, const char* name, const Vec3& v) const;
  void set(GLuint program, const char* name, const Rgba& v) const;
  void set(GLuint program, const char* name, float v) const { gl.Uniform1f(at(program, name), v); }
  void set(GLuint program, const char* name, const Eigen::Matrix4f& m) const;
  void send(const Geometry& geometry) const;
  void draw_shadow_casters(const Geometry& geometry) const;
  void draw_light_map(const Geometry& geometry, const Eigen::Matrix4f& light) const;
  void draw_floor_map(const Geometry& geometry, const StageView& stage, const Vec3& area,
                      const Vec3& to_key) const;
  void draw_floor(const StageView& stage, const Vec3& area) const;
  void draw_pieces(const Geometry& geometry) const;
  void draw_front(const Geometry& geometry) const;
  Picture read() const;
};

GLuint Painter::State::compile(GLenum kind, const char* source) {
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  return shader;
}

GLuint Painter::State::link(const char* vertex, const char* fragment) {
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {compile(GL_VERTEX_SHADER, vertex), compile(GL_FRAGMENT_SHADER, fragment)}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program);
  GLint linked = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) {
    std::array<char, 512> log{};
    gl.GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    trouble = std::string("shader: ") + log.data();
  }
  return program;
}

GLuint Painter::State::texture(GLint format, int w, int h, GLenum layout, GLenum type, const void* pixels) {
  GLuint id = 0;
  gl.GenTextures(1, &id);
  gl.BindTexture(GL_TEXTURE_2D, id);
  gl.TexImage2D(GL_TEXTURE_2D, 0, format, w, h, 0, layout, type, pixels);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return id;
}

GLuint Painter::State::upload(const Picture& picture) {
  const GLuint id =
      texture(GL_SRGB8_ALPHA8, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  gl.GenerateMipmap(GL_TEXTURE_2D);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  return id;
}

GLuint Painter::State::framebuffer(GLenum attachment, GLuint target) {
  GLuint id = 0;
  gl.GenFramebuffers(1, &id);
  gl.BindFramebuffer(GL_FRAMEBUFFER, id);
  if (target != 0) gl.FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, target, 0);
  return id;
}

GLuint Painter::State::renderbuffer(GLenum format) {
  GLint most = 0;
  gl.GetIntegerv(GL_MAX_SAMPLES, &most);
  GLuint id = 0;
  gl.GenRenderbuffers(1, &id);
  gl.BindRenderbuffer(GL_RENDERBUFFER, id);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, std::min(kSamples, most), format, width, height);
  return id;
}

bool Painter::State::complete() {
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
  trouble = "a framebuffer of " + std::to_string(width) + " x " + std::to_string(height) + " is refused";
  return false;
}

bool Painter::State::make_targets() {
  multisampled = framebuffer(GL_COLOR_ATTACHMENT0, 0);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                             renderbuffer(GL_SRGB8_ALPHA8));
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                             renderbuffer(GL_DEPTH_COMPONENT24));
  bool good = complete();
  resolved = framebuffer(GL_COLOR_ATTACHMENT0,
                         texture(GL_SRGB8_ALPHA8, width, height, GL_RGBA, GL_UNSIGNED_BYTE, nullptr));
  good = good && complete();

  light_map = texture(GL_DEPTH_COMPONENT24, kLightMapSize, kLightMapSize, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
                      nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  light_target = framebuffer(GL_DEPTH_ATTACHMENT, light_map);

  flat_map = texture(GL_RGBA8, kFloorMapSize, kFloorMapSize, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  flat_target = framebuffer(GL_COLOR_ATTACHMENT0, flat_map);
  good = good && complete();
  shadow_map = texture(GL_RG8, kFloorMapSize, kFloorMapSize, GL_RG, GL_UNSIGNED_BYTE, nullptr);
  return good;
}

void Painter::State::make_buffers() {
  gl.GenVertexArrays(1, &vertex_array);
  gl.BindVertexArray(vertex_array);
  gl.GenBuffers(1, &vertex_buffer);
  gl.BindBuffer(GL_ARRAY_BUFFER, vertex_buffer);
  gl.GenBuffers(1, &index_buffer);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer);
  const auto attribute = [&](GLuint slot, GLint numbers, std::size_t offset) {
    gl.EnableVertexAttribArray(slot);
    gl.VertexAttribPointer(slot, numbers, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                           reinterpret_cast<const void*>(offset));
  };
  attribute(0, 3, offsetof(Vertex, position));
  attribute(1, 3, offsetof(Vertex, normal));
  attribute(2, 2, offsetof(Vertex, uv));
  attribute(3, 4, offsetof(Vertex, color));
}

void Painter::State::set_up() {
  if (!gl.load(*context)) {
    trouble = "an OpenGL function is missing";
    return;
  }
  surface = link(shaders::kSurfaceVertex, shaders::kSurfaceFragment);
  depth = link(shaders::kDepthVertex, shaders::kDepthFragment);
  flat = link(shaders::kFlatVertex, shaders::kFlatFragment);
  floor = link(shaders::kFloorVertex, shaders::kFloorFragment);
  if (!trouble.empty() || !make_targets()) return;
  make_buffers();
  white = upload({1, 1, {255, 255, 255, 255}});
}

/// In place of those it had.
bool Painter::State::take_textures(const std::vector<Picture>& pictures) {
  for (const GLuint id : textures)
    if (id != white) gl.DeleteTextures(1, &id);
  textures.clear();
  for (const Picture& picture : pictures) textures.push_back(picture.rgba.empty() ? white : upload(picture));
  if (gl.GetError() == GL_NO_ERROR) return true;
  trouble = "OpenGL refused a resource";
  return false;
}

void Painter::State::set(GLuint program, const char* name, const Vec3& v) const {
  gl.Uniform3f(at(program, name), static_cast<float>(v.x()), static_cast<float>(v.y()),
               static_cast<float>(v.z()));
}

void Painter::State::set(GLuint program, const char* name, const Rgba& v) const {
  gl.Uniform4f(at(program, name), v[0], v[1], v[2], v[3]);
}

void Painter::State::set(GLuint program, const char* name, const Eigen::Matrix4f& m) const {
  gl.UniformMatrix4fv(at(program, name), 1, GL_FALSE, m.data());
}

void Painter::State::send(const Geometry& geometry) const {
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(geometry.vertices.size() * sizeof(Vertex)),
                geometry.vertices.data(), GL_STREAM_DRAW);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                static_cast<GLsizeiptr>(geometry.indices.size() * sizeof(std::uint32_t)),
                geometry.indices.data(), GL_STREAM_DRAW);
}

void Painter::State::draw_shadow_casters(const Geometry& geometry) const {
  for (const Piece& piece : geometry.pieces)
    if (piece.surface.casts_shadow)
      gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.count), GL_UNSIGNED_INT,
                      reinterpret_cast<const void*>(piece.first * sizeof(std::uint32_t)));
}

void Painter::State::draw_light_map(const Geometry& geometry, const Eigen::Matrix4f& light) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, light_target);
  gl.Viewport(0, 0, kLightMapSize, kLightMapSize);
  gl.Enable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.Disable(GL_BLEND);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(2.0f, 4.0f);
  gl.UseProgram(depth);
  set(depth, "light_from_world", light);
  draw_shadow_casters(geometry);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void Painter::State::draw_floor_map(const Geometry& geometry, const StageView& stage, const Vec3& area,
                                    const Vec3& to_key) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, flat_target);
  gl.Viewport(0, 0, kFloorMapSize, kFloorMapSize);
  gl.Disable(GL_DEPTH_TEST);
  gl.Enable(GL_BLEND);
  gl.BlendEquation(GL_MAX);
  gl.ClearColor(0, 0, 0, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.UseProgram(flat);
  set(flat, "floor_area", area);
  set(flat, "floor_y", static_cast<float>(stage.floor_y));
  set(flat, "light", Vec3(to_key / to_key.y()));
  set(flat, "share", Vec3(1.0, 0.0, kContactReach_m));
  draw_shadow_casters(geometry);
  set(flat, "light", Vec3(Vec3::UnitY()));
  set(flat, "share", Vec3(0.0, 1.0, kContactReach_m));
  draw_shadow_casters(geometry);
  gl.BlendEquation(GL_FUNC_ADD);

  constexpr std::size_t kPixels = std::size_t{kFloorMapSize} * kFloorMapSize;
  std::vector<std::uint8_t> bytes(2 * kPixels);
  gl.ReadPixels(0, 0, kFloorMapSize, kFloorMapSize, GL_RG, GL_UNSIGNED_BYTE, bytes.data());
  const double pixels_per_metre = kFloorMapSize / (2.0 * area.z());
  for (const std::size_t channel : {0, 1}) {
    std::vector<float> map(kPixels);
    for (std::size_t i = 0; i < kPixels; ++i) map[i] = bytes[2 * i + channel];
    blur(map, kFloorMapSize, (channel == 0 ? kPenumbra_m : kContactBlur_m) * pixels_per_metre);
    for (std::size_t i = 0; i < kPixels; ++i)
      bytes[2 * i + channel] = static_cast<std::uint8_t>(std::clamp(map[i] + 0.5f, 0.0f, 255.0f));
  }
  gl.BindTexture(GL_TEXTURE_2D, shadow_map);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RG8, kFloorMapSize, kFloorMapSize, 0, GL_RG, GL_UNSIGNED_BYTE,
                bytes.data());
}

void Painter::State::draw_floor(const StageView& stage, const Vec3& area) const {
  Geometry quad;
  quad.begin({});
  const double side = 8.0 * stage.reach;
  for (const auto& [x, z] : {std::pair{-side, -side}, {-side, side}, {side, side}, {side, -side}})
    quad.vertices.push_back({Vec3(stage.focus.x() + x, stage.floor_y, stage.focus.z() + z).cast<float>(),
                             Eigen::Vector3f::UnitY(),
                             Eigen::Vector2f::Zero(),
                             {1, 1, 1, 1}});
  quad.indices = {0, 1, 2, 0, 2, 3};
  send(quad);
  gl.UseProgram(floor);
  set(floor, "clip_from_world", stage.camera.clip_from_world());
  set(floor, "floor_area", area);
  set(floor, "focus", Vec3(stage.focus.x(), stage.focus.z(), stage.reach));
  set(floor, "background", stage.theme.background);
  set(floor, "ground", stage.theme.ground);
  set(floor, "line", stage.theme.line);
  gl.BindTexture(GL_TEXTURE_2D, shadow_map);
  gl.DrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_INT, nullptr);
}

void Painter::State::draw_pieces(const Geometry& geometry) const {
  for (const Piece& piece : geometry.pieces) {
    const Surface& look = piece.surface;
    const bool blended = look.alpha == Material::Alpha::blend;
    (blended ? gl.Enable : gl.Disable)(GL_BLEND);
    gl.DepthMask(!blended);
    (look.double_sided ? gl.Disable : gl.Enable)(GL_CULL_FACE);
    gl.FrontFace(look.mirrored ? GL_CW : GL_CCW);
    set(surface, "base_color", look.color);
    set(surface, "alpha_cutoff", look.alpha == Material::Alpha::mask ? look.alpha_cutoff : -1.0f);
    set(surface, "gloss", look.gloss);
    set(surface, "takes_shadow", look.takes_shadow ? 1.0f : 0.0f);
    const bool textured = look.texture >= 0 && look.texture < static_cast<int>(textures.size());
    gl.BindTexture(GL_TEXTURE_2D, textured ? textures[look.texture] : white);
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.count), GL_UNSIGNED_INT,
                    reinterpret_cast<const void*>(piece.first * sizeof(std::uint32_t)));
  }
  gl.DepthMask(GL_TRUE);
  gl.FrontFace(GL_CCW);
}

/// Draws a transparent piece: its front faces only.
void Painter::State::draw_front(const Geometry& geometry) const {
  if (geometry.indices.empty()) return;
  send(geometry);
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_CULL_FACE);
  set(surface, "alpha_cutoff", -1.0f);
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(geometry.indices.size()), GL_UNSIGNED_INT, nullptr);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.DepthFunc(GL_LEQUAL);
  draw_pieces(geometry);
  gl.DepthFunc(GL_LESS);
}

Picture Painter::State::read() const {
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, multisampled);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
  gl.BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl.BindFramebuffer(GL_FRAMEBUFFER, resolved);
  Picture picture{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  const std::ptrdiff_t row = std::ptrdiff_t{4} * width;
  for (int y = 0; y < height / 2; ++y)
    std::swap_ranges(picture.rgba.begin() + y * row, picture.rgba.begin() + (y + 1) * row,
                     picture.rgba.begin() + (height - 1 - y) * row);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  return picture;
}

/// What the thread's last painter drew with: to compile its programs takes longer than to draw small
/// pictures.
struct Painter::Spare {
  static std::unique_ptr<State>& of_thread() {
    thread_local std::unique_ptr<State> state;
    return state;
  }
  /// Null where the spare one does not fit; it is given up then.
  static std::unique_ptr<State> take(int width, int height, OffscreenKind kind) {
    auto state = std::move(of_thread());
    const bool fits = state && state->width == width && state->height == height && state->asked == kind;
    return fits ? std::move(state) : nullptr;
  }
};

Painter::Painter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Painter::~Painter() { Spare::of_thread() = std::move(state_); }

Result<std::unique_ptr<Painter>> Painter::make(int width, int height, const std::vector<Picture>& textures,
                                               OffscreenKind kind) {
  auto state = Spare::take(width, height, kind);
  if (!state) {
    auto context = make_offscreen(kind);
    if (!context) return context.error();
    state = std::make_unique<State>(std::move(*context), kind, width, height);
    state->set_up();
  }
  if (!state->trouble.empty() || !state->take_textures(textures))
    return output_error({}, "cannot draw off-screen: " + state->trouble,
                        "ask for smaller cells, or leave the picture out");
  return std::unique_ptr<Painter>(new Painter(std::move(state)));
}

Picture Painter::draw(const FrameGeometry& frame, const StageView& stage) {
  const State& s = *state_;
  const Gl& gl = s.gl;
  const Vec3 to_key = towards(stage.camera, kKeyAzimuth, kKeyElevation);
  const ShadowBounds bounds = shadow_bounds(frame.solid, stage.focus);
  const Eigen::Matrix4f light = light_from_world(bounds, to_key);
  const Vec3 area = floor_area(bounds, stage.floor_y, to_key);

  gl.ActiveTexture(GL_TEXTURE0);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.Disable(GL_FRAMEBUFFER_SRGB);
  s.send(frame.solid);
  s.draw_light_map(frame.solid, light);
  s.draw_floor_map(frame.solid, stage, area, to_key);

  gl.BindFramebuffer(GL_FRAMEBUFFER, s.multisampled);
  gl.Viewport(0, 0, s.width, s.height);
  gl.Enable(GL_FRAMEBUFFER_SRGB);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_LESS);
  gl.Disable(GL_BLEND);
  gl.Disable(GL_CULL_FACE);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  const Rgba& background = stage.theme.background;
  gl.ClearColor(background[0], background[1], background[2], 1.0f);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  s.draw_floor(stage, area);

  s.send(frame.solid);
  gl.UseProgram(s.surface);
  s.set(s.surface, "clip_from_world", stage.camera.clip_from_world());
  s.set(s.surface, "light_from_world", light);
  s.set(s.surface, "eye", stage.camera.eye);
  s.set(s.surface, "to_key", to_key);
  s.set(s.surface, "to_rim", towards(stage.camera, kRimAzimuth, kRimElevation));
  gl.Uniform1i(s.at(s.surface, "base_texture"), 0);
  gl.Uniform1i(s.at(s.surface, "light_map"), 1);
  gl.ActiveTexture(GL_TEXTURE1);
  gl.BindTexture(GL_TEXTURE_2D, s.light_map);
  gl.ActiveTexture(GL_TEXTURE0);
  s.draw_pieces(frame.solid);
  s.draw_front(frame.ghost);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  s.draw_front(frame.overlay);
  gl.Disable(GL_FRAMEBUFFER_SRGB);
  return s.read();
}

}  // namespace ukemi
