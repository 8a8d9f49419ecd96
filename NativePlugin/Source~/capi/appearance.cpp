// SPDX-License-Identifier: MIT
// What vertices take from their atoms. A job that runs keeps what it was begun with: a change goes into another set,
// one that nobody holds any more if there is one, so that colours of every frame soon need no new memory.
#include "capi/appearance_in.h"
#include "capi/context.h"
#include "parallel/sole_holder.h"

using quickses::Appearance;
using quickses::check_atom_count;
using quickses::guarded;
using quickses::require;

namespace {

// Calls change(appearance) on one that only the context holds.
template <class Change>
void change_appearance(qses_context *context, size_t count, const char *function, const Change &change) {
  require(context, "context");
  check_atom_count(*context, count, function);
  std::shared_ptr<Appearance> next = quickses::find_unheld(context->appearance_pool);
  if (!next) {
    next = std::make_shared<Appearance>();
    context->appearance_pool.push_back(next);
  }
  *next = *context->appearance;
  change(*next);
  context->appearance = next;
}

}  // namespace

extern "C" {

qses_status qses_set_visible(qses_context *context, const uint8_t *visible, size_t count) {
  return guarded([&] {
    change_appearance(context, count, "qses_set_visible",
                      [&](Appearance &a) { quickses::copy_visible(visible, count, &a); });
  });
}

qses_status qses_set_colors(qses_context *context, const uint8_t *rgba, size_t count) {
  return guarded([&] {
    change_appearance(context, count, "qses_set_colors",
                      [&](Appearance &a) { quickses::copy_colors(rgba, count, &a); });
  });
}

qses_status qses_set_texcoords(qses_context *context, const float *uv, size_t count) {
  return guarded([&] {
    change_appearance(context, count, "qses_set_texcoords",
                      [&](Appearance &a) { quickses::copy_texcoords(uv, count, &a); });
  });
}

}  // extern "C"
