// SPDX-License-Identifier: MIT
#include "fuzz/fuzz.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace fuzz {

void require(bool holds, const char *what) {
  if (holds) return;
  std::fprintf(stderr, "not so: %s (%s)\n", what, qses_last_error());
  std::abort();
}

bool succeeds(qses_status status, std::initializer_list<qses_status> may_fail) {
  require(status == QSES_OK || std::count(may_fail.begin(), may_fail.end(), status) == 1, "an expected status");
  require(status == QSES_OK || qses_last_error()[0] != '\0', "a message");
  return status == QSES_OK;
}

bool is_position(float x) { return std::isfinite(x) && std::fabs(x) <= 1e6f; }

}  // namespace fuzz
