// SPDX-License-Identifier: MIT
// Files that are part of every page. The build makes their texts (cmake/QuicksesPageParts.cmake).
#pragma once

#include <string_view>

namespace quickses::render {

extern const std::string_view kPageStyle, kPageScript;
extern const std::string_view kThree, kTrackballControls;  // empty: not found when the program was built

}  // namespace quickses::render
