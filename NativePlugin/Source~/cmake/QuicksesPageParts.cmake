# SPDX-License-Identifier: MIT
# Makes the texts that are part of every page a source of C++; run by the build as a script:
#   cmake -DOUTPUT=page_parts.cpp -DSTYLE=... -DSCRIPT=... -DTHREE=... -DCONTROLS=... -P QuicksesPageParts.cmake
# THREE and CONTROLS may be empty.
set(_text "#include \"render/page_parts.h\"\n\nnamespace quickses::render {\nnamespace {\n")
set(_names "")
foreach(_part IN ITEMS "STYLE kPageStyle" "SCRIPT kPageScript" "THREE kThree" "CONTROLS kTrackballControls")
  string(REPLACE " " ";" _part "${_part}")
  list(GET _part 0 _file)
  list(GET _part 1 _name)
  if(NOT "${${_file}}" STREQUAL "")
    file(READ "${${_file}}" _bytes HEX)
    string(REGEX REPLACE "(..)" "'\\\\x\\1'," _bytes "${_bytes}")
    string(APPEND _text "const char ${_name}Bytes[] = {${_bytes}};\n")
    string(APPEND _names "const std::string_view ${_name}(${_name}Bytes, sizeof ${_name}Bytes);\n")
  else()
    string(APPEND _names "const std::string_view ${_name};\n")
  endif()
endforeach()
file(WRITE "${OUTPUT}" "${_text}}  // namespace\n\n${_names}\n}  // namespace quickses::render\n")
