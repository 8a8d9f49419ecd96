// SPDX-License-Identifier: MIT
// The part of the fake driver for buffers of graphics APIs. A buffer is host memory that the test makes under its
// OpenGL name or the address of its ID3D11Buffer. What is mapped is other memory, which is gone with the end of the
// mapping: only then the buffer has what was written there. Where the caller has said that it discards what was there,
// that begins as bytes 0xcd. Each call is a line of a log. A call that is told to fail does nothing, but unregistering.
#include "fake_driver.h"

#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

using namespace fake_driver;

namespace {

struct Buffer {
  int number;  // in the log
  std::vector<unsigned char> bytes;
  int registered = 0;
  bool is_mapped = false, is_spoilt = false;
};

// Knows the buffer also when there is another one of the same name.
struct Resource {
  std::shared_ptr<Buffer> buffer;
  bool discards;
  std::unique_ptr<unsigned char[]> mapped;  // as many bytes as the buffer has
  CUstream stream = nullptr;                // that it is mapped for
};

std::recursive_mutex mutex;
std::map<uint64_t, std::shared_ptr<Buffer>> buffers;
std::map<CUgraphicsResource, std::unique_ptr<Resource>> resources;
std::string lines, answer;
int drawing_device = 0;
void *drawing_d3d = nullptr;
thread_local bool can_draw = false;

using Lock = std::lock_guard<std::recursive_mutex>;

// Ends a call: what it does only happens where it succeeds.
template <class Call>
CUresult call(const std::string &line, const Call &does) {
  const Lock lock(mutex);
  bool fails = false;
  CUresult result = next(&fails);
  if (!fails) result = can_draw ? does() : CUDA_ERROR_INVALID_GRAPHICS_CONTEXT;
  lines += line + (result == CUDA_SUCCESS ? "\n" : " = " + std::to_string(result) + "\n");
  return result;
}

std::string name_of(uint64_t key) {
  const Lock lock(mutex);
  const auto found = buffers.find(key);
  return found == buffers.end() ? " unknown" : " " + std::to_string(found->second->number);
}

std::string names_of(unsigned count, CUgraphicsResource *list) {
  const Lock lock(mutex);
  std::string names;
  for (unsigned k = 0; k < count; ++k) {
    const auto found = resources.find(list[k]);
    names += found == resources.end() ? " unknown" : " " + std::to_string(found->second->buffer->number);
  }
  return names;
}

CUresult list_devices(unsigned *count, CUdevice *devices, unsigned room) {
  *count = 0;
  if (drawing_device < 0) return CUDA_ERROR_NO_DEVICE;
  if (room > 0) devices[0] = device_of(drawing_device);
  *count = 1;
  return CUDA_SUCCESS;
}

CUresult register_buffer(CUgraphicsResource *resource, uint64_t key, bool discards) {
  const auto found = buffers.find(key);
  if (found == buffers.end()) return CUDA_ERROR_INVALID_VALUE;
  ++found->second->registered;
  auto made = std::make_unique<Resource>();
  made->buffer = found->second;
  made->discards = discards;
  *resource = reinterpret_cast<CUgraphicsResource>(made.get());
  resources[*resource] = std::move(made);
  return CUDA_SUCCESS;
}

// Whether it can be mapped, or unmapped, as CUDA's manual says.
CUresult check(CUgraphicsResource resource, bool mapped) {
  const auto found = resources.find(resource);
  if (found == resources.end()) return CUDA_ERROR_INVALID_HANDLE;
  if (mapped) return found->second->mapped ? CUDA_SUCCESS : CUDA_ERROR_NOT_MAPPED;
  if (found->second->buffer->is_spoilt) return CUDA_ERROR_MAP_FAILED;
  return found->second->buffer->is_mapped ? CUDA_ERROR_ALREADY_MAPPED : CUDA_SUCCESS;
}

void map(Resource &resource, CUstream stream) {
  const std::vector<unsigned char> &bytes = resource.buffer->bytes;
  resource.buffer->is_mapped = true;
  resource.mapped = std::make_unique<unsigned char[]>(bytes.size());
  resource.stream = stream;
  if (resource.discards)
    std::memset(resource.mapped.get(), 0xcd, bytes.size());
  else
    std::memcpy(resource.mapped.get(), bytes.data(), bytes.size());
}

void unmap(Resource &resource, bool keep) {
  if (!resource.mapped) return;
  std::vector<unsigned char> &bytes = resource.buffer->bytes;
  if (keep) std::memcpy(bytes.data(), resource.mapped.get(), bytes.size());
  resource.mapped = nullptr;
  resource.buffer->is_mapped = false;
}

}  // namespace

void fake_driver::note_launch() {
  const Lock lock(mutex);
  if (can_draw) lines += "Launch\n";
}

bool fake_driver::is_mapped_for(CUdeviceptr memory, size_t bytes, CUstream stream) {
  const Lock lock(mutex);
  for (const auto &entry : resources) {
    const Resource &r = *entry.second;
    const CUdeviceptr begin = address(r.mapped.get());
    if (r.mapped && memory >= begin && memory + bytes <= begin + r.buffer->bytes.size()) return r.stream == stream;
  }
  return false;
}

// ---- for the test

// Makes a buffer, of bytes 0xee, instead of one that there was. number: in the log.
FAKE_API int fake_graphics_make(uint64_t key, int number, unsigned bytes) {
  const Lock lock(mutex);
  auto made = std::make_shared<Buffer>();
  made->number = number;
  made->bytes.assign(bytes, 0xee);
  buffers[key] = std::move(made);
  return 0;
}
// From now on it can't be mapped.
FAKE_API int fake_graphics_spoil(uint64_t key) {
  const Lock lock(mutex);
  buffers.at(key)->is_spoilt = true;
  return 0;
}
// Copies what it has.
FAKE_API int fake_graphics_read(uint64_t key, void *to, unsigned bytes) {
  const Lock lock(mutex);
  const std::vector<unsigned char> &from = buffers.at(key)->bytes;
  if (bytes > from.size()) return 0;
  std::memcpy(to, from.data(), bytes);
  return 1;
}
// How often buffers are registered.
FAKE_API int fake_graphics_registered() {
  const Lock lock(mutex);
  return static_cast<int>(resources.size());
}
// Which device draws, -1 for none; with which ID3D11Device, if any.
FAKE_API int fake_graphics_draw_on(int device, void *d3d) {
  const Lock lock(mutex);
  drawing_device = device;
  drawing_d3d = d3d;
  return 0;
}
// Whether the calling thread is the one that draws: no other one may call the functions of this file.
FAKE_API int fake_graphics_draw_here(int here) {
  can_draw = here != 0;
  return 0;
}
// The calls since this was called last. Valid until the next time.
FAKE_API const char *fake_graphics_log() {
  const Lock lock(mutex);
  answer.swap(lines);
  lines.clear();
  return answer.c_str();
}

// ---- the driver's

FAKE_API CUresult CUDAAPI cuGLGetDevices_v2(unsigned *count, CUdevice *devices, unsigned room, unsigned) {
  return call("GLGetDevices", [&] { return list_devices(count, devices, room); });
}
FAKE_API CUresult CUDAAPI cuGraphicsGLRegisterBuffer(CUgraphicsResource *resource, unsigned buffer, unsigned flags) {
  return call("GLRegisterBuffer" + name_of(buffer) + " flags " + std::to_string(flags),
              [&] { return register_buffer(resource, buffer, flags == CU_GRAPHICS_REGISTER_FLAGS_WRITE_DISCARD); });
}
FAKE_API CUresult CUDAAPI cuGraphicsResourceSetMapFlags_v2(CUgraphicsResource resource, unsigned flags) {
  return call("SetMapFlags" + names_of(1, &resource) + " flags " + std::to_string(flags), [&] {
    if (const CUresult refusal = check(resource, false)) return refusal;
    resources[resource]->discards = flags == CU_GRAPHICS_MAP_RESOURCE_FLAGS_WRITE_DISCARD;
    return CUDA_SUCCESS;
  });
}
FAKE_API CUresult CUDAAPI cuGraphicsMapResources(unsigned count, CUgraphicsResource *list, CUstream stream) {
  return call("Map" + names_of(count, list), [&] {
    CUresult refusal = count > 0 ? CUDA_SUCCESS : CUDA_ERROR_INVALID_VALUE;
    unsigned done = 0;
    for (; done < count && !refusal; ++done)
      if (!(refusal = check(list[done], false))) map(*resources[list[done]], stream);
    if (refusal && done > 0)
      while (--done > 0) unmap(*resources[list[done - 1]], false);  // all or none
    return refusal;
  });
}
FAKE_API CUresult CUDAAPI cuGraphicsResourceGetMappedPointer_v2(CUdeviceptr *pointer, size_t *size,
                                                                CUgraphicsResource resource) {
  return call("Pointer" + names_of(1, &resource), [&] {
    if (const CUresult refusal = check(resource, true)) return refusal;
    *pointer = address(resources[resource]->mapped.get());
    *size = resources[resource]->buffer->bytes.size();
    return CUDA_SUCCESS;
  });
}
FAKE_API CUresult CUDAAPI cuGraphicsUnmapResources(unsigned count, CUgraphicsResource *list, CUstream stream) {
  return call("Unmap" + names_of(count, list), [&] {
    for (unsigned k = 0; k < count; ++k) {
      if (const CUresult refusal = check(list[k], true)) return refusal;
      if (resources[list[k]]->stream != stream) return CUDA_ERROR_INVALID_VALUE;
    }
    for (unsigned k = 0; k < count; ++k) unmap(*resources[list[k]], true);
    return CUDA_SUCCESS;
  });
}
// One that is mapped is unmapped, but without what was written.
FAKE_API CUresult CUDAAPI cuGraphicsUnregisterResource(CUgraphicsResource resource) {
  const Lock lock(mutex);
  const CUresult result = call("Unregister" + names_of(1, &resource),
                               [&] { return resources.count(resource) ? CUDA_SUCCESS : CUDA_ERROR_INVALID_HANDLE; });
  if (const auto found = resources.find(resource); found != resources.end()) {
    unmap(*found->second, false);
    --found->second->buffer->registered;
    resources.erase(found);
  }
  return result;
}

#if defined(_WIN32)
FAKE_API CUresult CUDAAPI cuD3D11GetDevices(unsigned *count, CUdevice *devices, unsigned room, ID3D11Device *d3d,
                                            unsigned) {
  return call("D3D11GetDevices",
              [&] { return d3d == drawing_d3d ? list_devices(count, devices, room) : CUDA_ERROR_INVALID_VALUE; });
}
// Refuses one that is registered already, as CUDA's manual says.
FAKE_API CUresult CUDAAPI cuGraphicsD3D11RegisterResource(CUgraphicsResource *resource, ID3D11Resource *buffer,
                                                          unsigned flags) {
  const uint64_t key = reinterpret_cast<uintptr_t>(buffer);
  return call("D3D11RegisterResource" + name_of(key) + " flags " + std::to_string(flags), [&] {
    const auto found = buffers.find(key);
    const bool is_registered = found != buffers.end() && found->second->registered > 0;
    return is_registered ? CUDA_ERROR_INVALID_HANDLE : register_buffer(resource, key, false);
  });
}
#endif
