# Emscripten: WebAssembly for browsers and Node, on one thread, with 128-bit vector instructions (Eigen
# uses them under the names of SSE2) and exceptions of WebAssembly itself.
execute_process(COMMAND em-config EMSCRIPTEN_ROOT OUTPUT_VARIABLE emscripten_root
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
include(${emscripten_root}/cmake/Modules/Platform/Emscripten.cmake)
# Headers of the system that hold no machine's code: Eigen; the others are in web/packages.cmake.
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
# Eigen writes instructions of x86 for GCC before 6.3, as which it counts Clang, and from 6.0 on.
set(web_flags "-msimd128 -msse2 -fgnuc-version=5.99")
set(CMAKE_C_FLAGS_INIT "${web_flags}")
set(CMAKE_CXX_FLAGS_INIT
  "${web_flags} -fwasm-exceptions -include ${CMAKE_CURRENT_LIST_DIR}/../src/base/platform/missing_std.h")
