# Zig's C++ compiler (PyPI ziglang), for a glibc older than the build machine's and for other
# processors: -DLITTORAL_ZIG_TARGET=x86_64-linux-gnu.2.28. What Debian's packages hold is linked
# statically; their headers are reached one by one, since those of /usr/include belong to another libc.
set(LITTORAL_ZIG "" CACHE FILEPATH "The program zig")
set(LITTORAL_ZIG_TARGET x86_64-linux-gnu.2.28 CACHE STRING "Processor, system and glibc")
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LITTORAL_ZIG LITTORAL_ZIG_TARGET)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${LITTORAL_ZIG_TARGET})
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_LIBRARY_ARCHITECTURE ${CMAKE_SYSTEM_PROCESSOR}-linux-gnu)
set(CMAKE_C_COMPILER ${LITTORAL_ZIG} cc -target ${LITTORAL_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${LITTORAL_ZIG} c++ -target ${LITTORAL_ZIG_TARGET})
# CMake takes one word for the archiver.
foreach(language C CXX)
  set(CMAKE_${language}_ARCHIVE_CREATE "${LITTORAL_ZIG} ar qc <TARGET> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_APPEND "${LITTORAL_ZIG} ar q <TARGET> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_FINISH "${LITTORAL_ZIG} ranlib <TARGET>")
endforeach()
# Zig keeps what it has compiled by itself.
set(CMAKE_CXX_COMPILER_LAUNCHER "" CACHE STRING "")

set(headers ${CMAKE_CURRENT_LIST_DIR}/../build/zig/include)
file(MAKE_DIRECTORY ${headers})
foreach(header nlohmann png.h pngconf.h pnglibconf.h zlib.h zconf.h)
  file(CREATE_LINK /usr/include/${header} ${headers}/${header} SYMBOLIC)
endforeach()
file(COPY /usr/share/cmake/nlohmann_json DESTINATION ${headers}/../share/cmake)
set(nlohmann_json_DIR ${headers}/../share/cmake/nlohmann_json CACHE PATH "")
set(libraries /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE})
set(PNG_LIBRARY_RELEASE ${libraries}/libpng.a CACHE FILEPATH "")
set(PNG_PNG_INCLUDE_DIR ${headers} CACHE PATH "")
set(ZLIB_LIBRARY_RELEASE ${libraries}/libz.a CACHE FILEPATH "")
set(ZLIB_INCLUDE_DIR ${headers} CACHE PATH "")
