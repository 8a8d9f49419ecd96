// SPDX-License-Identifier: MIT
#include "graphics/gl_without_window.h"

#include <dlfcn.h>

#include <stdexcept>

namespace gl_without_window {
namespace {

// "EGL 1.5", Khronos, and its extensions EXT_platform_device, EXT_device_query and NV_device_cuda.
using Display = void *;
using Device = void *;
constexpr unsigned kPlatformDevice = 0x313F, kOpenGlApi = 0x30A2;
constexpr int kCudaDevice = 0x323A, kSurfaceType = 0x3033, kPbuffer = 1, kRenderableType = 0x3040, kOpenGlBit = 8,
              kMajorVersion = 0x3098, kMinorVersion = 0x30FB, kProfileMask = 0x30FD, kCoreProfile = 1, kNone = 0x3038;

struct Egl {
  AnyFunction (*GetProcAddress)(const char *name);
  unsigned (*Initialize)(Display display, int *major, int *minor);
  unsigned (*BindAPI)(unsigned api);
  unsigned (*ChooseConfig)(Display display, const int *wanted, void **configs, int room, int *count);
  void *(*CreateContext)(Display display, void *config, void *shared, const int *attributes);
  unsigned (*DestroyContext)(Display display, void *context);
  unsigned (*MakeCurrent)(Display display, void *draw, void *read, void *context);
  unsigned (*ReleaseThread)();
  unsigned (*QueryDevices)(int room, Device *devices, int *count);
  unsigned (*QueryDeviceAttrib)(Device device, int attribute, ptrdiff_t *value);
  Display (*GetPlatformDisplay)(unsigned platform, Device device, const int *attributes);
};

template <class Function>
void set(Function *function, void *address) {
  *function = reinterpret_cast<Function>(address);
}

// The display that EGL has for the GPU.
struct Place {
  Egl egl{};
  Display display = nullptr;
  void *config = nullptr;
  std::string refusal;

  Place() { refusal = open(); }

  std::string open() {
    void *const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) return "there is no libEGL.so.1 on this machine";
    set(&egl.GetProcAddress, dlsym(library, "eglGetProcAddress"));
    set(&egl.Initialize, dlsym(library, "eglInitialize"));
    set(&egl.BindAPI, dlsym(library, "eglBindAPI"));
    set(&egl.ChooseConfig, dlsym(library, "eglChooseConfig"));
    set(&egl.CreateContext, dlsym(library, "eglCreateContext"));
    set(&egl.DestroyContext, dlsym(library, "eglDestroyContext"));
    set(&egl.MakeCurrent, dlsym(library, "eglMakeCurrent"));
    set(&egl.ReleaseThread, dlsym(library, "eglReleaseThread"));
    if (!egl.GetProcAddress || !egl.Initialize || !egl.BindAPI || !egl.ChooseConfig || !egl.CreateContext ||
        !egl.DestroyContext || !egl.MakeCurrent || !egl.ReleaseThread)
      return "libEGL.so.1 lacks functions of EGL 1.4";
    set(&egl.QueryDevices, address("eglQueryDevicesEXT"));
    set(&egl.QueryDeviceAttrib, address("eglQueryDeviceAttribEXT"));
    set(&egl.GetPlatformDisplay, address("eglGetPlatformDisplayEXT"));
    if (!egl.QueryDevices || !egl.QueryDeviceAttrib || !egl.GetPlatformDisplay)
      return "EGL lacks the extensions for devices without a window";
    return find_display();
  }

  void *address(const char *name) const { return reinterpret_cast<void *>(egl.GetProcAddress(name)); }

  std::string find_display() {
    Device devices[16];
    int count = 0;
    egl.QueryDevices(16, devices, &count);
    for (int k = 0; k < count; ++k) {
      ptrdiff_t ordinal = -1;
      if (!egl.QueryDeviceAttrib(devices[k], kCudaDevice, &ordinal) || ordinal != 0) continue;
      display = egl.GetPlatformDisplay(kPlatformDevice, devices[k], nullptr);
      int major = 0, minor = 0, found = 0;
      if (!display || !egl.Initialize(display, &major, &minor)) return "EGL does not start on the GPU";
      const int wanted[] = {kSurfaceType, kPbuffer, kRenderableType, kOpenGlBit, kNone};
      egl.ChooseConfig(display, wanted, &config, 1, &found);
      return "";
    }
    return "none of EGL's " + std::to_string(count) + " devices is CUDA's device 0";
  }
};

const Place &place() {
  static const Place &found = *new Place;  // never unloaded: the driver has threads
  return found;
}

void load_functions() {
#define QUICKSES_GL_FUNCTION(Result, Name, Arguments) \
  set(&gl.Name, reinterpret_cast<void *>(find_function("gl" #Name)));
  QUICKSES_GL_FUNCTIONS(QUICKSES_GL_FUNCTION)
#undef QUICKSES_GL_FUNCTION
}

}  // namespace

Functions gl;

AnyFunction find_function(const char *name) { return place().egl.GetProcAddress(name); }

std::string refusal() {
  static const std::string why = []() -> std::string {
    if (!place().refusal.empty()) return place().refusal;
    try {
      const Context context;
      return "";
    } catch (const std::exception &e) {
      return e.what();
    }
  }();
  return why;
}

Context::Context() {
  const Place &p = place();
  if (!p.refusal.empty()) throw std::runtime_error(p.refusal);
  p.egl.BindAPI(kOpenGlApi);
  const int attributes[] = {kMajorVersion, 4, kMinorVersion, 5, kProfileMask, kCoreProfile, kNone};
  context_ = p.egl.CreateContext(p.display, p.config, nullptr, attributes);
  if (!context_) throw std::runtime_error("EGL makes no context of OpenGL 4.5");
  static const bool loaded = (load_functions(), true);
  static_cast<void>(loaded);
}

Context::~Context() { place().egl.DestroyContext(place().display, context_); }

void Context::make_current() const {
  const Place &p = place();
  p.egl.BindAPI(kOpenGlApi);  // each thread has a choice of its own
  if (!p.egl.MakeCurrent(p.display, nullptr, nullptr, context_))
    throw std::runtime_error("EGL does not make the context current");
}

void Context::release() {
  const Place &p = place();
  p.egl.MakeCurrent(p.display, nullptr, nullptr, nullptr);
}

void Fence::set() {
  wait();
  sync_ = gl.FenceSync(kSyncGpuCommandsComplete, 0);
  gl.Flush();
}

void Fence::wait() {
  if (!sync_) return;
  while (gl.ClientWaitSync(sync_, kSyncFlushCommands, 1000000000) == kTimeoutExpired) {
  }
  gl.DeleteSync(sync_);
  sync_ = nullptr;
}

std::vector<char> read_buffer(unsigned buffer, size_t bytes) {
  std::vector<char> read(bytes);
  if (bytes > 0) gl.GetNamedBufferSubData(buffer, 0, static_cast<ptrdiff_t>(bytes), read.data());
  return read;
}

}  // namespace gl_without_window
