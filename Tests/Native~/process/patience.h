// SPDX-License-Identifier: MIT
// How long tests wait for what has to come before they take it for a hang: longer than a busy machine stands still, and
// shorter than CTest waits for a test.
#pragma once

#include <chrono>

constexpr std::chrono::seconds kPatience{150};
