# Warnings and sanitizers for our own targets.
function(littoral_warnings target)
  if(LITTORAL_SANITIZE MATCHES thread)
    target_compile_options(${target} PRIVATE -w)  # the build for addresses warns; it is a tenth of the time
  else()
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wnon-virtual-dtor)
  endif()
  # Between files that are compiled together, a local name may well be another file's.
  if(NOT LITTORAL_UNITY)
    target_compile_options(${target} PRIVATE -Wshadow)
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE -Wshadow=local)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 reports std::string concatenation inside its own headers.
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overread)
  endif()
  # Only with the compilers of reference: others know warnings that nobody has seen yet.
  if(LITTORAL_WERROR AND
     ((CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13) OR
      (CMAKE_CXX_COMPILER_ID STREQUAL Clang AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 15)))
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(LITTORAL_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${LITTORAL_SANITIZE}
                           -fno-sanitize-recover=all -fno-omit-frame-pointer
                           $<$<CXX_COMPILER_ID:Clang>:-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizers.ignore>)
    target_link_options(${target} PUBLIC -fsanitize=${LITTORAL_SANITIZE})
  endif()
endfunction()
