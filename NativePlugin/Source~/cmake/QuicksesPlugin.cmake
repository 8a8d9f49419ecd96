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

set(_remove_stale "")
if(WIN32)
  # quickses.dll is the plug-in as it is: MinGW puts everything into it. Its table of symbols would be a third of it.
  target_link_options(quickses PRIVATE -Wl,-s)
  set(_platform windows-x86_64)
  set(_plugin quickses)
  set(_files "$<TARGET_FILE:quickses>")
  set(_file_metas quickses.dll.meta)
else()
  set(_platform linux-x86_64)
  set(_plugin quickses_plugin)
  set(_files "$<TARGET_FILE:quickses_plugin>")
  set(_file_metas libquickses.so.meta)
  set(_folder "${PROJECT_BINARY_DIR}/plugin")
  set(_system_library ${QUICKSES_CPU_LIBRARY})
  # A shared TBB travels along. Unity copies only names that end in .so, hence a name, and a soname, of our own; it is
  # also why no other TBB in the process is mistaken for it.
  set(_tbb_type none)
  if(QUICKSES_CPU_SYSTEM_FOUND STREQUAL "TBB")
    get_target_property(_tbb_type TBB::tbb TYPE)
  endif()
  if(_tbb_type STREQUAL "SHARED_LIBRARY")
    find_program(QUICKSES_PATCHELF patchelf DOC "Gives the copy of TBB that travels with the plug-in its name")
    mark_as_advanced(QUICKSES_PATCHELF)
    if(NOT QUICKSES_PATCHELF)
      quickses_no_plugin("patchelf was not found (bash Scripts~/setup.sh installs it)")
      return()
    endif()
    set(_system_library "${_folder}/libquickses_tbb.so")
    add_custom_command(OUTPUT "${_system_library}"
      COMMAND "${CMAKE_COMMAND}" -E copy "$<TARGET_FILE:TBB::tbb>" "${_system_library}"
      COMMAND "${QUICKSES_PATCHELF}" --remove-rpath --set-soname libquickses_tbb.so "${_system_library}"
      DEPENDS "$<TARGET_FILE:TBB::tbb>" VERBATIM)
    add_custom_target(quickses_tbb DEPENDS "${_system_library}")
    list(APPEND _files "${_system_library}")
    list(APPEND _file_metas libquickses_tbb.so.meta)
  else() # one may lie there, from a build with it
    set(_stale "${QUICKSES_PLUGINS_DIR}/${_platform}/libquickses_tbb.so")
    set(_remove_stale COMMAND "${CMAKE_COMMAND}" -E rm -f "${_stale}" "${_stale}.meta")
  endif()

  # The same objects as libquickses.so, linked so that nothing but the C library and libgcc_s is asked of the machine (of TBB beside it also libstdc++).
  add_library(quickses_plugin SHARED ${_objects})
  quickses_link_library(quickses_plugin ${_system_library})
  set_target_properties(quickses_plugin PROPERTIES OUTPUT_NAME quickses LIBRARY_OUTPUT_DIRECTORY "${_folder}"
    BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "$ORIGIN")
  # What nobody calls goes: in the static libstdc++ of Debian 12 alone that is what asks for glibc 2.36 (arc4random).
  target_link_options(quickses_plugin PRIVATE -static-libstdc++ -Wl,--gc-sections -Wl,-s)
  if(TARGET quickses_tbb)
    add_dependencies(quickses_plugin quickses_tbb)
  endif()
endif()

# Placed by every build, even if nothing had to be compiled: of several presets, the one that was built last is in place.
set(_metas "${PROJECT_SOURCE_DIR}/NativePlugin/Source~/plugin_metas")
list(TRANSFORM _file_metas PREPEND "${_metas}/${_platform}/")
add_custom_target(plugin ALL
  COMMAND "${CMAKE_COMMAND}" -E make_directory "${QUICKSES_PLUGINS_DIR}/${_platform}"
  ${_remove_stale}
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different ${_files} ${_file_metas} "${QUICKSES_PLUGINS_DIR}/${_platform}"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${_metas}/${_platform}.meta" "${QUICKSES_PLUGINS_DIR}"
  COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${_metas}/Plugins.meta" "${QUICKSES_PLUGINS_DIR}.meta"
  DEPENDS ${_plugin} VERBATIM)

find_program(QUICKSES_PYTHON python3 DOC "Packs the package; runs the tests of the program and of the package's files")
mark_as_advanced(QUICKSES_PYTHON)
if(QUICKSES_PYTHON)
  add_custom_target(upm
    COMMAND "${QUICKSES_PYTHON}" -B "${PROJECT_SOURCE_DIR}/Scripts~/package/make-package" "${PROJECT_BINARY_DIR}"
    DEPENDS plugin VERBATIM USES_TERMINAL)
endif()
