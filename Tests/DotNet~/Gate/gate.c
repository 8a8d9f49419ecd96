/* SPDX-License-Identifier: MIT */
/* Stands before the native library: calls that may start CUDA wait while the gate is closed, as they do on a machine
 * where that takes long. A call by the thread that closed it is counted instead, and goes through. */
#define _GNU_SOURCE
#include <quickses/quickses.h>

#include <dlfcn.h>
#include <pthread.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t opened = PTHREAD_COND_INITIALIZER;
static pthread_t keeper;
static int is_closed, waiting, keeper_calls, is_preparing;

void gate_close(void) {
  pthread_mutex_lock(&mutex);
  keeper = pthread_self();
  is_closed = 1;
  keeper_calls = is_preparing = 0;
  pthread_mutex_unlock(&mutex);
}

/* From now on qses_backend_info no longer waits, but says that a GPU is prepared. */
void gate_prepare(void) {
  pthread_mutex_lock(&mutex);
  is_preparing = 1;
  pthread_cond_broadcast(&opened);
  pthread_mutex_unlock(&mutex);
}

/* How many calls the thread that closed it has made meanwhile. */
int gate_open(void) {
  int calls;
  pthread_mutex_lock(&mutex);
  is_closed = is_preparing = 0;
  calls = keeper_calls;
  pthread_cond_broadcast(&opened);
  pthread_mutex_unlock(&mutex);
  return calls;
}

int gate_waiting(void) {
  int count;
  pthread_mutex_lock(&mutex);
  count = waiting;
  pthread_mutex_unlock(&mutex);
  return count;
}

/* Whether it was left because a GPU is prepared. */
static int pass(int ends_when_preparing) {
  int is_told;
  pthread_mutex_lock(&mutex);
  if (is_closed && pthread_equal(pthread_self(), keeper)) {
    ++keeper_calls;
  } else {
    ++waiting;
    while (is_closed && !(ends_when_preparing && is_preparing)) pthread_cond_wait(&opened, &mutex);
    --waiting;
  }
  is_told = ends_when_preparing && is_preparing;
  pthread_mutex_unlock(&mutex);
  return is_told;
}

#define NEXT(function) ((__typeof__(&function))dlsym(RTLD_NEXT, #function))

qses_status qses_context_create(const qses_context_options *options, qses_context **context) {
  pass(0);
  return NEXT(qses_context_create)(options, context);
}

void qses_context_destroy(qses_context *context) {
  pass(0);
  NEXT(qses_context_destroy)(context);
}

qses_status qses_device_count(uint32_t *count) {
  pass(0);
  return NEXT(qses_device_count)(count);
}

qses_status qses_backend_info(qses_backend backend, qses_backend_description *description) {
  if (backend != QSES_BACKEND_CPU && pass(1)) {
    description->available = description->preparing = 1;
    strcpy(description->device, "a GPU");
    strcpy(description->reason, "the driver compiles");
    return QSES_OK;
  }
  return NEXT(qses_backend_info)(backend, description);
}
