// SPDX-License-Identifier: MIT
// What happens when the program is stopped from outside (Ctrl-C, kill, a terminal that closes, a pipe nobody reads).
#pragma once

namespace quickses::cli {

// From now on the program takes its temporary files with it when it is stopped, or memory runs out where nothing can be
// thrown; a pipe that breaks and a limit of file sizes are errors of writing instead. Call it once, before there are
// other threads.
void prepare_for_stopping();

}  // namespace quickses::cli
