// SPDX-License-Identifier: MIT
// Windows: where the library is entered (-Wl,--entry). When a process ends, Windows has ended all of its other threads
// before, wherever they were: the C++ runtime's destructors would wait for ever for a lock that one of them had. So
// nothing is taken down then, as the documentation of DllMain asks for; the system takes everything back.
#include <windows.h>

extern "C" {

// MinGW's: constructors and destructors.
BOOL WINAPI DllMainCRTStartup(HINSTANCE library, DWORD reason, LPVOID reserved);

BOOL WINAPI quickses_library_entry(HINSTANCE library, DWORD reason, LPVOID reserved) {
  const bool process_ends = reason == DLL_PROCESS_DETACH && reserved != nullptr;
  return process_ends ? TRUE : DllMainCRTStartup(library, reason, reserved);
}
}
