# SPDX-License-Identifier: MIT
# The library as Unity takes it: placed in UnityPackage/Plugins/<platform>, with .meta files whose GUIDs never change
# (templates in plugin_metas/), and the target upm, which packs everything into org.quickses.unity-<version>.tgz.
set(QUICKSES_PLUGINS_DIR "${PROJECT_SOURCE_DIR}/UnityPackage/Plugins" CACHE PATH "Where the plug-in is placed")
mark_as_advanced(QUICKSES_PLUGINS_DIR)

function(quickses_no_plugin reason)
  message(STATUS "No plug-in for Unity: ${reason}")
  add_custom_target(plugin COMMAND "${CMAKE_COMMAND}" -E echo "No plug-in for Unity: ${reason}" COMMAND "${CMAKE_COMMAND}" -E false)
  add_custom_target(upm DEPENDS plugin)
endfunction()

if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" OR NOT CMAKE_SYSTEM_NAME MATCHES "^(Linux|Windows)$")
  quickses_no_plugin("it is made for Linux and Windows on x86-64")
  return()
elseif(NOT BUILD_SHARED_LIBS OR QUICKSES_SANITIZE)
  quickses_no_plugin("it needs a shared library without sanitizers")
  return()
endif()

if(WIN32)
  # quickses.dll is the plug-in as it is: MinGW puts everything into it. Its table of symbols would be a third of it.
  target_link_options(quickses PRIVATE -Wl,-s)
  set(_plugin quickses)
  set(_folder windows-x86_64)
  set(_meta quickses.dll.meta)
else()
  # The same objects as libquickses.so, linked so that nothing but the C library and libgcc_s is asked of the machine.
  add_library(quickses_plugin SHARED ${_objects})
  quickses_link_library(quickses_plugin)
  set_target_properties(quickses_plugin PROPERTIES OUTPUT_NAME quickses LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/plugin"
    SKIP_BUILD_RPATH ON)
  # What nobody calls goes: in the static libstdc++ of Debian 12 alone that is what asks for glibc 2.36 (arc4random).
  target_link_options(quickses_plugin PRIVATE -static-libstdc++ -Wl,--gc-sections -Wl,-s)
  set(_plugin quickses_plugin)
  set(_folder linux-x86_64)
  set(_meta libquickses.so.meta)
endif()

# Placed by every build, even if nothing had to be compiled: of several presets, the one that was built last is in place.
set(_metas "${PROJECT_SOURCE_DIR}/NativePlugin/Source~/plugin_metas")
add_custom_target(plugin ALL
  COMMAND "${CMAKE_COMMAND}" -E make_directory "${QUICKSES_PLUGINS_DIR}/${_folder}"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "$<TARGET_FILE:${_plugin}>" "${_metas}/${_folder}/${_meta}"
    "${QUICKSES_PLUGINS_DIR}/${_folder}"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${_metas}/${_folder}.meta" "${QUICKSES_PLUGINS_DIR}"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${_metas}/Plugins.meta" "${QUICKSES_PLUGINS_DIR}.meta"
  DEPENDS ${_plugin} VERBATIM)

if(QUICKSES_PYTHON)
  add_custom_target(upm
    COMMAND "${QUICKSES_PYTHON}" -B "${PROJECT_SOURCE_DIR}/Scripts~/package/make-package" "${PROJECT_BINARY_DIR}"
    DEPENDS plugin VERBATIM USES_TERMINAL)
endif()
