# What the library needs besides Eigen, for WebAssembly. Debian's headers are taken one by one: the
# folder that they are in is that of another machine's C library. zlib is compiled from the copy of its
# source that an npm package holds.
foreach(header nlohmann/json.hpp fast_float/fast_float.h boost/multiprecision/cpp_int.hpp)
  find_path(folder_of_${header} ${header} PATHS /usr/include /usr/local/include NO_CMAKE_FIND_ROOT_PATH)
  if(NOT folder_of_${header})
    message(FATAL_ERROR "${header} not found: scripts/setup.sh web installs it")
  endif()
  string(REGEX REPLACE "/.*" "" name ${header})
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/headers)
  file(CREATE_LINK ${folder_of_${header}}/${name} ${CMAKE_BINARY_DIR}/headers/${name} SYMBOLIC)
endforeach()
# Eigen includes it with SSE2's, and uses nothing of it.
file(TOUCH ${CMAKE_BINARY_DIR}/headers/mmintrin.h)
add_library(littoral_web_headers INTERFACE)
target_include_directories(littoral_web_headers SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/headers)
add_library(nlohmann_json::nlohmann_json ALIAS littoral_web_headers)

find_program(LITTORAL_NODE NAMES node nodejs REQUIRED NO_CMAKE_FIND_ROOT_PATH)
find_program(LITTORAL_NPM npm REQUIRED NO_CMAKE_FIND_ROOT_PATH)
set(web_modules ${CMAKE_BINARY_DIR}/node_modules)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS web/package-lock.json)
file(SHA256 ${CMAKE_SOURCE_DIR}/web/package-lock.json web_lock)
if(NOT EXISTS ${web_modules}/${web_lock})
  file(COPY ${CMAKE_SOURCE_DIR}/web/package.json ${CMAKE_SOURCE_DIR}/web/package-lock.json
       DESTINATION ${CMAKE_BINARY_DIR})
  execute_process(COMMAND ${LITTORAL_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
                  WORKING_DIRECTORY ${CMAKE_BINARY_DIR} COMMAND_ERROR_IS_FATAL ANY)
  file(TOUCH ${web_modules}/${web_lock})
endif()

set(zlib ${web_modules}/zlib-sync/deps/zlib)
add_library(littoral_web_zlib STATIC ${zlib}/adler32.c ${zlib}/crc32.c ${zlib}/inffast.c
            ${zlib}/inflate.c ${zlib}/inftrees.c ${zlib}/uncompr.c ${zlib}/zutil.c)
target_include_directories(littoral_web_zlib SYSTEM PUBLIC ${zlib})
target_compile_options(littoral_web_zlib PRIVATE -O2 -w)
add_library(ZLIB::ZLIB ALIAS littoral_web_zlib)
