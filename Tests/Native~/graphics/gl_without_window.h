// SPDX-License-Identifier: MIT
// OpenGL 4.5 on the GPU without a window, for tests and benchmarks: EGL is loaded when it is asked for, so that nothing
// of it is needed to build, and machines without it can say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gl_without_window {

using Sync = struct SyncObject *;

// Names and numbers are those of OpenGL: "OpenGL 4.5 (Core Profile)", Khronos.
constexpr unsigned kNoError = 0, kRenderer = 0x1F01, kStreamDraw = 0x88E0, kStreamRead = 0x88E1, kDynamicDraw = 0x88E8,
                   kSyncGpuCommandsComplete = 0x9117, kSyncFlushCommands = 1, kTimeoutExpired = 0x911B;

#define QUICKSES_GL_FUNCTIONS(X)                                                                               \
  X(unsigned, GetError, ())                                                                                    \
  X(const unsigned char *, GetString, (unsigned name))                                                         \
  X(void, Finish, ())                                                                                          \
  X(void, Flush, ())                                                                                           \
  X(void, CreateBuffers, (int n, unsigned *buffers))                                                           \
  X(void, DeleteBuffers, (int n, const unsigned *buffers))                                                     \
  X(void, NamedBufferData, (unsigned buffer, ptrdiff_t size, const void *data, unsigned usage))                \
  X(void, NamedBufferSubData, (unsigned buffer, ptrdiff_t at, ptrdiff_t size, const void *data))               \
  X(void, GetNamedBufferSubData, (unsigned buffer, ptrdiff_t at, ptrdiff_t size, void *data))                  \
  X(void, CopyNamedBufferSubData, (unsigned from, unsigned to, ptrdiff_t at, ptrdiff_t to_at, ptrdiff_t size)) \
  X(Sync, FenceSync, (unsigned condition, unsigned flags))                                                     \
  X(unsigned, ClientWaitSync, (Sync sync, unsigned flags, uint64_t nanoseconds))                               \
  X(void, DeleteSync, (Sync sync))

// Loaded with the first context.
struct Functions {
#define QUICKSES_GL_FUNCTION(Result, Name, Arguments) Result(*Name) Arguments = nullptr;
  QUICKSES_GL_FUNCTIONS(QUICKSES_GL_FUNCTION)
#undef QUICKSES_GL_FUNCTION
};
extern Functions gl;

// A function that is not in the list; nullptr: there is none.
using AnyFunction = void (*)();
AnyFunction find_function(const char *name);

// Why there can be no context on a GPU that CUDA knows; empty: there can.
std::string refusal();

// A context without a surface, on the GPU that is CUDA's device 0. It is current nowhere.
class Context {
 public:
  Context();  // throws std::runtime_error
  ~Context();
  Context(const Context &) = delete;
  Context &operator=(const Context &) = delete;

  void make_current() const;  // on the calling thread
  static void release();      // the calling thread has no context any more

 private:
  void *context_ = nullptr;
};

// A fence behind what was drawn so far, on the thread that draws.
class Fence {
 public:
  Fence() = default;
  ~Fence() { wait(); }
  Fence(const Fence &) = delete;
  Fence &operator=(const Fence &) = delete;
  void set();
  void wait();  // until it is reached; at once if none is set

 private:
  Sync sync_ = nullptr;
};

// The first bytes of a buffer, when all that was drawn before is done.
std::vector<char> read_buffer(unsigned buffer, size_t bytes);

}  // namespace gl_without_window
