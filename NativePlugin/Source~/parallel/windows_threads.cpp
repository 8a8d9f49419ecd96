// SPDX-License-Identifier: MIT
#include "parallel/windows_threads.h"

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include <atomic>
#include <new>

namespace quickses {

struct WindowsThreads::Pool {
  TP_CALLBACK_ENVIRON environment;
  PTP_POOL pool = nullptr;
  PTP_WORK helper = nullptr;
  // What is being worked on.
  void (*work)(const void *, size_t) = nullptr;
  const void *context = nullptr;
  std::atomic<size_t> next_worker{0};

  Pool() { InitializeThreadpoolEnvironment(&environment); }
  ~Pool() {
    if (helper) CloseThreadpoolWork(helper);
    if (pool) CloseThreadpool(pool);
    DestroyThreadpoolEnvironment(&environment);
  }
  bool open(unsigned helpers) {
    pool = CreateThreadpool(nullptr);
    if (!pool) return false;
    SetThreadpoolThreadMaximum(pool, helpers);
    SetThreadpoolCallbackPool(&environment, pool);
    helper = CreateThreadpoolWork(&Pool::help, this, &environment);
    return helper != nullptr;
  }
  static void CALLBACK help(PTP_CALLBACK_INSTANCE, void *of, PTP_WORK) {
    Pool &pool = *static_cast<Pool *>(of);
    pool.work(pool.context, pool.next_worker.fetch_add(1));
  }
};

WindowsThreads::WindowsThreads(unsigned helpers) noexcept : pool_(new (std::nothrow) Pool) {
  if (!pool_ || pool_->open(helpers)) return;
  delete pool_;
  pool_ = nullptr;
}

WindowsThreads::~WindowsThreads() { delete pool_; }

void WindowsThreads::run(size_t workers, void (*work)(const void *, size_t), const void *context) noexcept {
  pool_->work = work;
  pool_->context = context;
  pool_->next_worker = 1;
  for (size_t worker = 1; worker < workers; ++worker) SubmitThreadpoolWork(pool_->helper);
  work(context, 0);
  WaitForThreadpoolWorkCallbacks(pool_->helper, TRUE);  // those that did not begin are taken back
}

}  // namespace quickses
#endif
