// SPDX-License-Identifier: MIT
// The same where the library is part of the program, which nobody loads anew as the process ends.
#include "capi/process_end_test.cpp"
