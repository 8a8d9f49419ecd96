// SPDX-License-Identifier: MIT
// Arguments and messages in UTF-8 on Windows, which has other encodings for both; elsewhere they are what they are.
#pragma once

namespace quickses::cli {

// Replaces the arguments of main, and sets the console to UTF-8, for as long as the program runs.
void use_utf8(int *argc, char ***argv);
// Sets the console back, in which others follow: at the end, or where the program is stopped.
void leave_utf8() noexcept;

}  // namespace quickses::cli
