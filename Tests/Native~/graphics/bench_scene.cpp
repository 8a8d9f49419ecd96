// SPDX-License-Identifier: MIT
#include "graphics/bench_scene.h"

#include "graphics/gl_without_window.h"

#include <algorithm>
#include <stdexcept>

namespace bench_scene {
namespace {

// Numbers of "OpenGL 4.5 (Core Profile)", Khronos.
constexpr unsigned kTriangles = 4, kCullFace = 0x0B44, kDepthTest = 0x0B71, kTexture2D = 0x0DE1, kUnsignedByte = 0x1401,
                   kUnsignedInt = 0x1405, kFloat = 0x1406, kColor = 0x1800, kDepth = 0x1801, kRgba8 = 0x8058,
                   kTimeElapsed = 0x88BF, kQueryResult = 0x8866, kFragmentShader = 0x8B30, kVertexShader = 0x8B31,
                   kLinkStatus = 0x8B82, kDepth32F = 0x8CAC, kColorAttachment = 0x8CE0, kDepthAttachment = 0x8D00,
                   kFramebuffer = 0x8D40;

#define QUICKSES_SCENE_FUNCTIONS(X)                                                                               \
  X(unsigned, CreateShader, (unsigned kind))                                                                      \
  X(void, ShaderSource, (unsigned shader, int n, const char *const *texts, const int *lengths))                   \
  X(void, CompileShader, (unsigned shader))                                                                       \
  X(void, DeleteShader, (unsigned shader))                                                                        \
  X(unsigned, CreateProgram, ())                                                                                  \
  X(void, DeleteProgram, (unsigned program))                                                                      \
  X(void, AttachShader, (unsigned program, unsigned shader))                                                      \
  X(void, LinkProgram, (unsigned program))                                                                        \
  X(void, GetProgramiv, (unsigned program, unsigned what, int *value))                                            \
  X(void, UseProgram, (unsigned program))                                                                         \
  X(void, Uniform4fv, (int at, int n, const float *values))                                                       \
  X(void, CreateTextures, (unsigned kind, int n, unsigned *textures))                                             \
  X(void, DeleteTextures, (int n, const unsigned *textures))                                                      \
  X(void, TextureStorage2D, (unsigned texture, int levels, unsigned format, int width, int height))               \
  X(void, CreateFramebuffers, (int n, unsigned *framebuffers))                                                    \
  X(void, DeleteFramebuffers, (int n, const unsigned *framebuffers))                                              \
  X(void, NamedFramebufferTexture, (unsigned framebuffer, unsigned attachment, unsigned texture, int level))      \
  X(void, BindFramebuffer, (unsigned where, unsigned framebuffer))                                                \
  X(void, ClearNamedFramebufferfv, (unsigned framebuffer, unsigned what, int which, const float *value))          \
  X(void, Viewport, (int x, int y, int width, int height))                                                        \
  X(void, Enable, (unsigned what))                                                                                \
  X(void, CreateVertexArrays, (int n, unsigned *arrays))                                                          \
  X(void, DeleteVertexArrays, (int n, const unsigned *arrays))                                                    \
  X(void, BindVertexArray, (unsigned array))                                                                      \
  X(void, EnableVertexArrayAttrib, (unsigned array, unsigned which))                                              \
  X(void, VertexArrayAttribFormat,                                                                                \
    (unsigned array, unsigned which, int n, unsigned kind, unsigned char normalized, unsigned at))                \
  X(void, VertexArrayAttribBinding, (unsigned array, unsigned which, unsigned binding))                           \
  X(void, VertexArrayVertexBuffer, (unsigned array, unsigned binding, unsigned buffer, ptrdiff_t at, int stride)) \
  X(void, VertexArrayElementBuffer, (unsigned array, unsigned buffer))                                            \
  X(void, DrawElements, (unsigned kind, int n, unsigned type, const void *at))                                    \
  X(void, CreateQueries, (unsigned kind, int n, unsigned *queries))                                               \
  X(void, DeleteQueries, (int n, const unsigned *queries))                                                        \
  X(void, BeginQuery, (unsigned kind, unsigned query))                                                            \
  X(void, EndQuery, (unsigned kind))                                                                              \
  X(void, GetQueryObjectui64v, (unsigned query, unsigned what, uint64_t *value))

struct SceneFunctions {
#define QUICKSES_SCENE_FUNCTION(Result, Name, Arguments) \
  Result(*Name) Arguments = reinterpret_cast<Result(*) Arguments>(gl_without_window::find_function("gl" #Name));
  QUICKSES_SCENE_FUNCTIONS(QUICKSES_SCENE_FUNCTION)
#undef QUICKSES_SCENE_FUNCTION
};

const SceneFunctions &gl() {
  static const SceneFunctions functions;
  return functions;
}

constexpr const char *kVertexText = R"(#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
layout(location = 0) uniform vec4 middle_and_scale;
layout(location = 0) out vec3 light_normal;
layout(location = 1) out vec4 light_color;
void main() {
  vec3 p = (position - middle_and_scale.xyz) * middle_and_scale.w;
  light_normal = normal;
  light_color = color;
  gl_Position = vec4(p.x * 9.0 / 16.0, p.y, -0.5 * p.z, 1.0);
}
)";

constexpr const char *kFragmentText = R"(#version 450
layout(location = 0) in vec3 light_normal;
layout(location = 1) in vec4 light_color;
layout(location = 0) out vec4 pixel;
void main() {
  float facing = max(dot(normalize(light_normal), normalize(vec3(0.4, 0.6, 0.8))), 0.0);
  pixel = vec4(light_color.rgb * (0.2 + 0.8 * facing) + 0.25 * pow(facing, 40.0), 1.0);
}
)";

void attach(unsigned program, unsigned kind, const char *text) {
  const unsigned shader = gl().CreateShader(kind);
  gl().ShaderSource(shader, 1, &text, nullptr);
  gl().CompileShader(shader);
  gl().AttachShader(program, shader);
  gl().DeleteShader(shader);
}

}  // namespace

View::View(const qses_mesh &mesh) {
  float half = 1;
  for (int d = 0; d < 3; ++d) {
    middle_and_scale[d] = 0.5f * (mesh.bounds_min[d] + mesh.bounds_max[d]);
    half = std::max(half, 0.5f * (mesh.bounds_max[d] - mesh.bounds_min[d]));
  }
  middle_and_scale[3] = 0.95f / half;
}

Scene::Scene() {
  program_ = gl().CreateProgram();
  attach(program_, kVertexShader, kVertexText);
  attach(program_, kFragmentShader, kFragmentText);
  gl().LinkProgram(program_);
  int is_linked = 0;
  gl().GetProgramiv(program_, kLinkStatus, &is_linked);
  if (!is_linked) throw std::runtime_error("OpenGL refuses the shaders");
  gl().CreateTextures(kTexture2D, 2, textures_);
  gl().TextureStorage2D(textures_[0], 1, kRgba8, kWidth, kHeight);
  gl().TextureStorage2D(textures_[1], 1, kDepth32F, kWidth, kHeight);
  gl().CreateFramebuffers(1, &framebuffer_);
  gl().NamedFramebufferTexture(framebuffer_, kColorAttachment, textures_[0], 0);
  gl().NamedFramebufferTexture(framebuffer_, kDepthAttachment, textures_[1], 0);
  gl().CreateVertexArrays(1, &vertex_array_);
  struct {
    int n;
    unsigned kind, at, binding;
  } const attributes[] = {{3, kFloat, 0, 0}, {3, kFloat, 12, 0}, {4, kUnsignedByte, 0, 1}};
  for (unsigned which = 0; which < 3; ++which) {
    const auto &a = attributes[which];
    gl().EnableVertexArrayAttrib(vertex_array_, which);
    gl().VertexArrayAttribFormat(vertex_array_, which, a.n, a.kind, a.kind == kUnsignedByte, a.at);
    gl().VertexArrayAttribBinding(vertex_array_, which, a.binding);
  }
  gl().CreateQueries(kTimeElapsed, 1, &query_);
  gl().BindFramebuffer(kFramebuffer, framebuffer_);
  gl().Viewport(0, 0, kWidth, kHeight);
  gl().Enable(kDepthTest);
  gl().Enable(kCullFace);
  gl().UseProgram(program_);
}

Scene::~Scene() {
  gl().DeleteQueries(1, &query_);
  gl().DeleteVertexArrays(1, &vertex_array_);
  gl().DeleteFramebuffers(1, &framebuffer_);
  gl().DeleteTextures(2, textures_);
  gl().DeleteProgram(program_);
}

void Scene::draw(const qses_gpu_buffers &buffers, const View &view, uint32_t index_count) {
  const float white[4] = {1, 1, 1, 1}, far = 1;
  gl().ClearNamedFramebufferfv(framebuffer_, kColor, 0, white);
  gl().ClearNamedFramebufferfv(framebuffer_, kDepth, 0, &far);
  gl().Uniform4fv(0, 1, view.middle_and_scale);
  gl().BindVertexArray(vertex_array_);
  gl().VertexArrayVertexBuffer(vertex_array_, 0, static_cast<unsigned>(buffers.vertices), 0, 24);
  gl().VertexArrayVertexBuffer(vertex_array_, 1, static_cast<unsigned>(buffers.colors), 0, 4);
  gl().VertexArrayElementBuffer(vertex_array_, static_cast<unsigned>(buffers.indices));
  gl().BeginQuery(kTimeElapsed, query_);
  gl().DrawElements(kTriangles, static_cast<int>(index_count), kUnsignedInt, nullptr);
  gl().EndQuery(kTimeElapsed);
}

double Scene::draw_ms() const {
  uint64_t nanoseconds = 0;
  gl().GetQueryObjectui64v(query_, kQueryResult, &nanoseconds);
  return 1e-6 * static_cast<double>(nanoseconds);
}

}  // namespace bench_scene
