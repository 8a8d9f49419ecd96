// SPDX-License-Identifier: MIT
// Arguments and messages in UTF-8 on Windows, which has other encodings for both; elsewhere they are what they are.
#pragma once

namespace quickses::cli {

// Replaces the arguments of main, for as long as the program runs, and sets the console to UTF-8.
void use_utf8(int *argc, char ***argv);

}  // namespace quickses::cli
