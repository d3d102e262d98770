# cmake -D SOURCES=FOLDER -D TOOLS=TEXT -D OUT=FILE.cpp -P build_id.cmake
# Writes build_id() (build_id.h): a hash of every file below SOURCES, its name with it, and of TOOLS.
file(GLOB_RECURSE files RELATIVE ${SOURCES} ${SOURCES}/*.h ${SOURCES}/*.cpp)
list(SORT files)
set(all "${TOOLS}\n")
foreach(file ${files})
  file(SHA256 ${SOURCES}/${file} hash)
  string(APPEND all "${hash} ${file}\n")
endforeach()
string(SHA256 id "${all}")
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
#include "base/build_id.h"

std::string_view ukemi::build_id() { return "@id@"; }
]] @ONLY)
