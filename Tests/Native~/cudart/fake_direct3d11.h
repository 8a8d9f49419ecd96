// SPDX-License-Identifier: MIT
// A device and buffers of Direct3D 11 without Direct3D: as much of them as the library asks for, with counts of who
// holds on to them.
#pragma once

#include <gtest/gtest.h>

#include <d3d11.h>

namespace fake_driver {

// Holds a count that must be that of its owner alone in the end, and never less.
class Counted {
 public:
  ~Counted() { EXPECT_EQ(count_, 1u) << "held by so many"; }
  ULONG add() { return ++count_; }
  ULONG release() {
    EXPECT_GT(count_, 1u) << "released by someone who does not hold it";
    return --count_;
  }

 private:
  ULONG count_ = 1;
};

// The functions that all objects have: nothing else is asked of a device.
class FakeDirect3D11Device final : public IUnknown {
 public:
  HRESULT STDMETHODCALLTYPE QueryInterface(REFIID, void **) override { return E_NOINTERFACE; }
  ULONG STDMETHODCALLTYPE AddRef() override { return held_.add(); }
  ULONG STDMETHODCALLTYPE Release() override { return held_.release(); }
  ID3D11Device *as_device() { return reinterpret_cast<ID3D11Device *>(static_cast<IUnknown *>(this)); }

 private:
  Counted held_;
};

class FakeDirect3D11Buffer final : public ID3D11Buffer {
 public:
  FakeDirect3D11Buffer(FakeDirect3D11Device &device, unsigned bytes) : device_(device) {
    description.ByteWidth = bytes;
  }

  HRESULT STDMETHODCALLTYPE QueryInterface(REFIID, void **) override { return E_NOINTERFACE; }
  ULONG STDMETHODCALLTYPE AddRef() override { return held_.add(); }
  ULONG STDMETHODCALLTYPE Release() override { return held_.release(); }
  void STDMETHODCALLTYPE GetDevice(ID3D11Device **device) override {
    device_.AddRef();
    *device = device_.as_device();
  }
  void STDMETHODCALLTYPE GetDesc(D3D11_BUFFER_DESC *out) override { *out = description; }
  void STDMETHODCALLTYPE GetType(D3D11_RESOURCE_DIMENSION *type) override { *type = D3D11_RESOURCE_DIMENSION_BUFFER; }
  HRESULT STDMETHODCALLTYPE GetPrivateData(REFGUID, UINT *, void *) override { return E_NOTIMPL; }
  HRESULT STDMETHODCALLTYPE SetPrivateData(REFGUID, UINT, const void *) override { return E_NOTIMPL; }
  HRESULT STDMETHODCALLTYPE SetPrivateDataInterface(REFGUID, const IUnknown *) override { return E_NOTIMPL; }
  void STDMETHODCALLTYPE SetEvictionPriority(UINT) override {}
  UINT STDMETHODCALLTYPE GetEvictionPriority() override { return 0; }

  D3D11_BUFFER_DESC description{0, D3D11_USAGE_DEFAULT, D3D11_BIND_VERTEX_BUFFER, 0, 0, 0};

 private:
  FakeDirect3D11Device &device_;
  Counted held_;
};

}  // namespace fake_driver
