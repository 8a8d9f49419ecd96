# SPDX-License-Identifier: MIT
# Install rules: the library, its headers, the program, and what find_package and pkg-config read.
include(CMakePackageConfigHelpers)

if(NOT BUILD_SHARED_LIBS AND TARGET gemmi_cpp)
  message(FATAL_ERROR "A static library can't be installed with a gemmi that was fetched, which nobody could link it with: "
    "install gemmi, or set BUILD_SHARED_LIBS=ON, or QUICKSES_INSTALL=OFF.")
endif()

install(TARGETS quickses EXPORT quicksesTargets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(FILES include/quickses/quickses.h include/quickses/quickses_gpu.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/quickses")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE.md" "${PROJECT_SOURCE_DIR}/Third Party Notices.md"
  DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES "${PROJECT_SOURCE_DIR}/Documentation~/licenses/Apache-2.0.txt" # where the notices refer to it
  DESTINATION "${CMAKE_INSTALL_DOCDIR}/Documentation~/licenses")
if(TARGET quickses_cli)
  install(TARGETS quickses_cli RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
  # The manual page and the completion are written by the program itself, from its table of options.
  if(UNIX AND NOT CMAKE_CROSSCOMPILING)
    set(_page "${PROJECT_BINARY_DIR}/share/quickses.1")
    set(_completion "${PROJECT_BINARY_DIR}/share/quickses")
    file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/share")
    add_custom_command(TARGET quickses_cli POST_BUILD BYPRODUCTS "${_page}" "${_completion}" VERBATIM
      COMMAND sh -c "\"$0\" --help-man > \"$1\" && \"$0\" --help-completion > \"$2\""
        "$<TARGET_FILE:quickses_cli>" "${_page}" "${_completion}")
    install(FILES "${_page}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
    install(FILES "${_completion}" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
  endif()
endif()

# ---- find_package(quickses CONFIG)
set(_config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/quickses")
install(EXPORT quicksesTargets NAMESPACE quickses:: DESTINATION "${_config_dir}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/quicksesConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/quicksesConfig.cmake" INSTALL_DESTINATION "${_config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/quicksesConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/quicksesConfig.cmake" "${PROJECT_BINARY_DIR}/quicksesConfigVersion.cmake"
  DESTINATION "${_config_dir}")

# ---- pkg-config
set(QUICKSES_PC_CFLAGS "")
set(QUICKSES_PC_LIBS "")
if(NOT BUILD_SHARED_LIBS)
  set(QUICKSES_PC_CFLAGS " -DQSES_STATIC")
  if(QUICKSES_GEMMI_LIBRARIES)
    string(APPEND QUICKSES_PC_LIBS " -lgemmi_cpp")
  endif()
  string(APPEND QUICKSES_PC_LIBS " -lz -lstdc++ -lm -lpthread")
  if(QUICKSES_CUDA)
    string(APPEND QUICKSES_PC_LIBS " -ldl")
  endif()
endif()
file(RELATIVE_PATH QUICKSES_PC_PREFIX "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" QUICKSES_PC_PREFIX "${QUICKSES_PC_PREFIX}")
configure_file("${CMAKE_CURRENT_LIST_DIR}/quickses.pc.in" "${PROJECT_BINARY_DIR}/quickses.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/quickses.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
