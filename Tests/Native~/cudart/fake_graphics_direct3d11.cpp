// SPDX-License-Identifier: MIT
// What only Direct3D 11 has: buffers that CUDA can't write, and objects with counts. What it shares with OpenGL is in
// the other files of fake_graphics_test, of which this is a part.
#include "cudart/fake_graphics_fixture.h"

namespace {

using namespace fake_driver;

class Direct3D11 : public GraphicsTestOfApi {};
INSTANTIATE_TEST_SUITE_P(Apis, Direct3D11, testing::Values(QSES_GRAPHICS_D3D11), name_of_api);

// Nothing is asked of CUDA then, and the other surfaces are served.
TEST_P(Direct3D11, RefusesBuffersThatCudaCantWrite) {
  const HandMadeMesh mesh(1);
  const struct {
    D3D11_USAGE usage;
    UINT cpu_access, misc;
    const char *word;
  } refused[] = {{D3D11_USAGE_DYNAMIC, D3D11_CPU_ACCESS_WRITE, 0, "default usage"},
                 {D3D11_USAGE_IMMUTABLE, 0, 0, "default usage"},
                 {D3D11_USAGE_STAGING, D3D11_CPU_ACCESS_READ, 0, "default usage"},
                 {D3D11_USAGE_DEFAULT, 0, D3D11_RESOURCE_MISC_SHARED, "shared"},
                 {D3D11_USAGE_DEFAULT, 0, D3D11_RESOURCE_MISC_SHARED_KEYEDMUTEX, "shared"}};
  for (const auto &kind : refused) {
    SCOPED_TRACE(kind.word);
    const DrawnSurface bad(api(), 1), other(api(), 3);
    D3D11_BUFFER_DESC &description = bad.indices().description();
    description.Usage = kind.usage;
    description.CPUAccessFlags = kind.cpu_access;
    description.MiscFlags = kind.misc;
    expect_ok(bad.submit(mesh));
    expect_ok(other.submit(mesh));
    draw();
    bad.expect_status(QSES_BACKEND_UNAVAILABLE, {"Direct3D 11", kind.word});
    other.expect_status(QSES_OK, {});
    other.expect_shows(mesh);
    // The one that could be registered is let go of.
    EXPECT_EQ(tell_driver("fake_graphics_registered"), 2);
    expect_ok(other.submit(mesh));
    draw();
    other.expect_status(QSES_OK, {});
  }
}

TEST_P(Direct3D11, AsksForTheDeviceOfTheBuffersAndLetsGoOfIt) {
  const HandMadeMesh mesh(1);
  const DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(mesh));
  int somebody_elses = 0;
  void *const not_ours = &somebody_elses;
  tell_driver("fake_graphics_draw_on", 0, not_ours);
  draw();
  surface.expect_status(QSES_DEVICE_ERROR, {"cudaD3D11GetDevices"});
  EXPECT_EQ(direct3d11_device().held_by(), 1u);
  draw_on(0);
  expect_ok(surface.submit(mesh));
  draw();
  surface.expect_status(QSES_OK, {});
  EXPECT_EQ(direct3d11_device().held_by(), 1u);
}

}  // namespace
